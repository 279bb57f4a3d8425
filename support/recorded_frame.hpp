// RecordedFrame: a recording's frame as a frame folder, for what draws pictures of it later.
#pragma once

#include <filesystem>

#include "flowdlo/frame_folder.hpp"
#include "flowdlo/result.hpp"
#include "frame_list.hpp"

namespace flowdlo::support {

/// Of `out`/frames/<name of the recording>/<name of the frame>.
[[nodiscard]] std::filesystem::path recorded_frame_folder(const std::filesystem::path& out,
                                                          const FrameEntry& entry);

/// Reads `entry` and writes it to that folder: depths in millimetres where they are whole ones,
/// otherwise in tenths; beyond 65 m there is none. What comes back is what was recorded, not what
/// was written. Fails as `entry` does, and with kIo.
[[nodiscard]] Result<FrameFolder> keep_recorded_frame(const std::filesystem::path& out,
                                                      const FrameEntry& entry);

}  // namespace flowdlo::support
