// Frame: one RGB-D observation of a rope, or of several, as views into the caller's memory.
#pragma once

#include <cstdint>
#include <span>

#include "flowdlo/export.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo {

/// Pinhole camera, pixels; the centre of the top left pixel is (0, 0). Eq. (2.2).
struct Intrinsics {
  float fx = 0;
  float fy = 0;
  float cx = 0;
  float cy = 0;
};

/// One observation. Views only: the caller keeps the memory alive during the call. Images are
/// row-major without padding. Depth and mask are aligned to the camera of `intrinsics`.
struct Frame {
  int width = 0;   ///< pixels, 1..4096
  int height = 0;  ///< pixels, 1..4096
  Intrinsics intrinsics;
  std::span<const float> depth_m;  ///< [height, width] z-depth, metres; 0 or not finite: none
  /// [height, width] the rope, or the ropes, where > 127. A strand field puts that of one rope
  /// right where it is too wide, too narrow or aside by up to half a rope's width.
  std::span<const std::uint8_t> mask;
  std::span<const std::uint8_t> color_bgr;  ///< [height, width, 3], or empty: not needed
  /// [height, width] which rope the mask shows, 1..65535, 0: none or unknown; or empty: unknown.
  /// Of one rope, every other label is a thing that may hide it; only the mask's pixels are ropes.
  std::span<const std::uint16_t> instances{};
};

/// Succeeds when sizes fit, the intrinsics are usable, and depths are metres: not most of those on
/// the mask above 100. Otherwise kBadInput with every fault.
[[nodiscard]] FLOWDLO_EXPORT Result<void> validate(const Frame& frame);

}  // namespace flowdlo
