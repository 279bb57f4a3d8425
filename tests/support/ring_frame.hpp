// RingFrame: a ring on a table, oval, that nothing hides, and its true nodes.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include "flowdlo/centerline.hpp"
#include "flowdlo/frame.hpp"
#include "support/disc.hpp"

namespace flowdlo::testing {

/// 320 x 240 px, the rope 9 px thick and 0.5 m away, with a picture.
struct RingFrame {
  RingFrame()
      : depth_m(static_cast<std::size_t>(kWidth) * kHeight, kTable_m),
        mask(static_cast<std::size_t>(kWidth) * kHeight, 0),
        color_bgr(3 * static_cast<std::size_t>(kWidth) * kHeight, 90) {
    for (int i = 0; i < kPoints; ++i) {
      const Point3 p = at(static_cast<double>(i) / kPoints);
      draw(kFocal * p.x / p.z + 160, kFocal * p.y / p.z + 120);
    }
    for (std::size_t i = 0; i < kNodes; ++i) truth[i] = at(static_cast<double>(i) / (kNodes - 1));
  }

  [[nodiscard]] Frame frame() const {
    return {.width = kWidth,
            .height = kHeight,
            .intrinsics = {kFocal, kFocal, 160, 120},
            .depth_m = depth_m,
            .mask = mask,
            .color_bgr = color_bgr};
  }

  static constexpr int kWidth = 320;
  static constexpr int kHeight = 240;
  static constexpr int kPoints = 4000;
  static constexpr int kHalfWidth_px = 4;
  static constexpr float kFocal = 300;
  static constexpr float kAxis_m = 0.5F;
  static constexpr float kTable_m = 0.5075F;
  static constexpr float kRadius_m = 0.0075F;  // of the rope
  std::vector<float> depth_m;
  std::vector<std::uint8_t> mask;
  std::vector<std::uint8_t> color_bgr;
  Centerline truth{};  ///< once round, evenly by angle alone

 private:
  static Point3 at(double share) {
    const double angle = 2 * std::numbers::pi * share;
    return {static_cast<float>(0.13 * std::cos(angle)), static_cast<float>(0.11 * std::sin(angle)),
            kAxis_m};
  }

  void draw(float u, float v) {
    paint_disc(u, v, kHalfWidth_px, kWidth, [&](std::size_t pixel, float off) {
      const float height_m = kRadius_m * std::sqrt(1 - off);
      mask[pixel] = 255;
      if (kAxis_m - height_m > depth_m[pixel]) return;
      depth_m[pixel] = kAxis_m - height_m;
      color_bgr[3 * pixel] = 30;
      color_bgr[3 * pixel + 1] = 60;
      color_bgr[3 * pixel + 2] = static_cast<std::uint8_t>(120 + 100 * (1 - off));
    });
  }
};

}  // namespace flowdlo::testing
