// RoseFrame: a rope laid in three petals that all cross at one place, at one depth. Nobody can see
// there which petal goes on into which, nor where the ends are: there is always doubt.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include "flowdlo/frame.hpp"
#include "support/disc.hpp"

namespace flowdlo::testing {

/// 320 x 240 px, the rope 11 px thick and 0.5 m away.
struct RoseFrame {
  RoseFrame()
      : depth_m(static_cast<std::size_t>(kWidth) * kHeight, kTable_m),
        mask(static_cast<std::size_t>(kWidth) * kHeight, 0) {
    for (int i = 0; i < kPoints; ++i) {
      const float angle = std::numbers::pi_v<float> * static_cast<float>(i) / kPoints;
      const float from_centre_px = kPetal_px * std::cos(3 * angle);
      draw(160 + from_centre_px * std::cos(angle), 120 + from_centre_px * std::sin(angle));
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
  static constexpr int kPoints = 2000;
  static constexpr float kPetal_px = 100;
  static constexpr int kHalfWidth_px = 5;
  static constexpr float kRope_m = 0.5F;
  static constexpr float kTable_m = 0.51F;
  std::vector<float> depth_m;
  std::vector<std::uint8_t> mask;

 private:
  void draw(float u, float v) {
    paint_disc(u, v, kHalfWidth_px, kWidth, [&](std::size_t pixel, float) {
      mask[pixel] = 255;
      depth_m[pixel] = kRope_m;
    });
  }
};

}  // namespace flowdlo::testing
