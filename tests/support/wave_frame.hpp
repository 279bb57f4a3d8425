// A small drawn frame: one rope along a sine wave, with a strip of its depth missing.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "flowdlo/frame.hpp"

namespace flowdlo::testing {

struct WaveFrame {
  int width;
  int height;
  Intrinsics camera;
  std::vector<float> depth_m;
  std::vector<std::uint8_t> mask;

  explicit WaveFrame(int image_width = 320, int image_height = 240, float rope_px = 9.0F)
      : width(image_width),
        height(image_height),
        camera{.fx = 0.95F * static_cast<float>(image_width),
               .fy = 0.95F * static_cast<float>(image_width),
               .cx = 0.5F * static_cast<float>(image_width - 1),
               .cy = 0.5F * static_cast<float>(image_height - 1)},
        depth_m(static_cast<std::size_t>(image_width) * image_height, 0.0F),
        mask(static_cast<std::size_t>(image_width) * image_height, 0) {
    for (int u = width / 10; u < width - width / 10; ++u) {
      const float phase = static_cast<float>(u) / static_cast<float>(width) * 9.0F;
      const float centre =
          0.5F * static_cast<float>(height) + 0.2F * static_cast<float>(height) * std::sin(phase);
      const float slope =
          0.2F * static_cast<float>(height) * std::cos(phase) * 9.0F / static_cast<float>(width);
      const float half = 0.5F * rope_px * std::sqrt(1.0F + slope * slope);
      for (int v = static_cast<int>(std::ceil(centre - half)); v <= static_cast<int>(centre + half);
           ++v) {
        const auto pixel = static_cast<std::size_t>(v) * width + static_cast<std::size_t>(u);
        mask[pixel] = 255;
        const bool hole = u > width / 2 && u < width / 2 + width / 20;
        depth_m[pixel] = hole ? 0.0F : 0.40F + 0.0001F * static_cast<float>(u);
      }
    }
  }

  [[nodiscard]] Frame frame() const { return {width, height, camera, depth_m, mask, {}}; }
};

}  // namespace flowdlo::testing
