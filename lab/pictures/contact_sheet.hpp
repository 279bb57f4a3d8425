// ContactSheet: many synthetic frames on one image, to be looked at.
#pragma once

#include <filesystem>
#include <span>

#include "flowdlo/result.hpp"
#include "synth/synthetic_frame.hpp"

namespace flowdlo::pictures {

/// A PNG of three pictures a frame: colour with the truth drawn over it (its hidden parts, too),
/// depth in colours from near to far (black: none), and mask. Fails with kIo.
[[nodiscard]] Result<void> save_contact_sheet(const std::filesystem::path& file,
                                              std::span<const synth::SyntheticFrame> frames);

}  // namespace flowdlo::pictures
