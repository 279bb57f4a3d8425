// BagImage: image messages as the pixels of a frame.
#pragma once

#include <string>

#include "flowdlo/result.hpp"
#include "picture.hpp"
#include "recording/bag.hpp"

namespace flowdlo::recording {

/// Of rgb8, bgr8, rgba8, bgra8, mono8 (and 8UC1, 8UC3, 8UC4, in BGR order), or of a JPEG or PNG.
/// Fails with kBadInput, naming `who`.
[[nodiscard]] Result<support::Picture> color_image(const ImageMessage& message,
                                                   const std::string& who);

/// Metres of 16UC1 (mm) or 32FC1 (m), raw, as PNG, or as the PNG of compressedDepth; 0 or not
/// finite: none.
[[nodiscard]] Result<image::Image<float>> depth_image(const ImageMessage& message,
                                                      const std::string& who);

/// 8 bits, the rope over 127, of mono8 or 8UC1, raw or as JPEG or PNG.
[[nodiscard]] Result<image::Mask> mask_image(const ImageMessage& message, const std::string& who);

}  // namespace flowdlo::recording
