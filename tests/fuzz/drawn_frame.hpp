// DrawnFrame: a small frame that a fuzzer's bytes draw. Strokes, so that ropes, loops and crossings
// are a few bytes away from one another; then pixels to flip.
#pragma once

#include <cstdint>
#include <vector>

#include "byte_source.hpp"
#include "flowdlo/frame.hpp"

namespace flowdlo::fuzz {

struct DrawnFrame {
  int width = 0;   ///< pixels
  int height = 0;  ///< pixels
  Intrinsics camera;
  std::vector<float> depth_m;
  std::vector<std::uint8_t> mask;

  [[nodiscard]] Frame frame() const { return {width, height, camera, depth_m, mask, {}}; }
};

/// Takes all of `bytes`: two sides of at most `most_px`, the camera, the background, how many
/// strokes, each stroke in kStrokeBytes, and bits that flip pixels, row by row.
[[nodiscard]] DrawnFrame draw_frame(ByteSource& bytes, int most_px);

inline constexpr int kStrokeBytes = 6;  ///< kind and thickness, both ends, depth

}  // namespace flowdlo::fuzz
