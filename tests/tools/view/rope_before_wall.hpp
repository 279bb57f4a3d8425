// RopeBeforeWall: a frame that sample_estimate() is of.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "flowdlo/frame.hpp"

namespace flowdlo::test {

/// A grey rope, half a metre away, before a wall at one metre.
struct RopeBeforeWall {
  static constexpr int kWidth = 80;
  static constexpr int kHeight = 60;
  std::vector<float> depth_m = std::vector<float>(kWidth * kHeight, 1.0F);
  std::vector<std::uint8_t> color_bgr = std::vector<std::uint8_t>(3 * kWidth * kHeight, 90);
  std::vector<std::uint8_t> mask = std::vector<std::uint8_t>(kWidth * kHeight, 0);

  RopeBeforeWall() {
    for (std::size_t u = 10; u < 68; ++u) {
      mask[29 * kWidth + u] = 255;
      depth_m[29 * kWidth + u] = 0.5F;
    }
    depth_m[0] = 0;
  }
  [[nodiscard]] Frame frame() const {
    Frame frame;
    frame.width = kWidth;
    frame.height = kHeight;
    frame.depth_m = depth_m;
    frame.color_bgr = color_bgr;
    frame.mask = mask;
    frame.intrinsics = {100, 100, 39.5, 29.5};
    return frame;
  }
};

}  // namespace flowdlo::test
