// RingFrame: a rope closed to a ring. Nobody can see where its ends are: there is always doubt.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "flowdlo/frame.hpp"

namespace flowdlo::testing {

/// 320 x 240 px, the rope 10 px thick and 0.5 m away.
struct RingFrame {
  RingFrame() {
    for (int v = 0; v < kHeight; ++v) {
      for (int u = 0; u < kWidth; ++u) {
        const float off_px = std::abs(
            std::hypot(static_cast<float>(u) - 160, static_cast<float>(v) - 120) - kRadius_px);
        mask.push_back(off_px <= kHalfWidth_px ? 255 : 0);
        depth_m.push_back(off_px <= kHalfWidth_px ? kRope_m : kTable_m);
      }
    }
  }

  [[nodiscard]] Frame frame() const {
    return {.width = kWidth,
            .height = kHeight,
            .intrinsics = {300, 300, 160, 120},
            .depth_m = depth_m,
            .mask = mask,
            .color_bgr = {}};
  }

  static constexpr int kWidth = 320;
  static constexpr int kHeight = 240;
  static constexpr float kRadius_px = 80;
  static constexpr float kHalfWidth_px = 5;
  static constexpr float kRope_m = 0.5F;
  static constexpr float kTable_m = 0.51F;
  std::vector<float> depth_m;
  std::vector<std::uint8_t> mask;
};

}  // namespace flowdlo::testing
