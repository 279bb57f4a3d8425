// PictureFile: one colour image as a frame that has nothing else.
#pragma once

#include <filesystem>

#include "flowdlo/frame_folder.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::tools {

/// Reads a PNG of 8 bits: size and colour, no depth, no camera; the mask is 0 everywhere. Fails
/// with kIo or kBadInput, naming the file.
[[nodiscard]] Result<FrameFolder> load_picture(const std::filesystem::path& file);

}  // namespace flowdlo::tools
