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

  /// Ends are cut along the image's columns, aslant as an occluder does it, or square as a rope's.
  explicit WaveFrame(int image_width = 320, int image_height = 240, float rope_px = 9.0F,
                     bool square_ends = false)
      : width(image_width),
        height(image_height),
        camera{.fx = 0.95F * static_cast<float>(image_width),
               .fy = 0.95F * static_cast<float>(image_width),
               .cx = 0.5F * static_cast<float>(image_width - 1),
               .cy = 0.5F * static_cast<float>(image_height - 1)},
        depth_m(static_cast<std::size_t>(image_width) * image_height, 0.0F),
        mask(static_cast<std::size_t>(image_width) * image_height, 0) {
    const int first = width / 10;
    const int last = width - width / 10 - 1;
    const auto reach = square_ends ? static_cast<int>(rope_px) : 0;
    for (int u = first - reach; u <= last + reach; ++u) {
      const float centre = centre_at(u);
      const float slope = slope_at(u);
      const float half = 0.5F * rope_px * std::sqrt(1.0F + slope * slope);
      for (int v = static_cast<int>(std::ceil(centre - half)); v <= static_cast<int>(centre + half);
           ++v) {
        if (square_ends && (beyond(first, u, v) < 0 || beyond(last, u, v) > 0)) continue;
        const auto pixel = static_cast<std::size_t>(v) * width + static_cast<std::size_t>(u);
        mask[pixel] = 255;
        const bool hole = u > width / 2 && u < width / 2 + width / 20;
        depth_m[pixel] = hole ? 0.0F : 0.40F + 0.0001F * static_cast<float>(u);
      }
    }
  }

  /// Of the axis, at a column.
  [[nodiscard]] float centre_at(int u) const {
    return static_cast<float>(height) * (0.5F + 0.2F * std::sin(phase_at(u)));
  }
  [[nodiscard]] float slope_at(int u) const {
    return 0.2F * static_cast<float>(height) * std::cos(phase_at(u)) * 9.0F /
           static_cast<float>(width);
  }

  [[nodiscard]] Frame frame() const { return {width, height, camera, depth_m, mask, {}}; }

 private:
  [[nodiscard]] float phase_at(int u) const {
    return static_cast<float>(u) / static_cast<float>(width) * 9.0F;
  }
  /// How far a pixel lies to the right of the line square to the axis at column `at`, pixels.
  [[nodiscard]] float beyond(int at, int u, int v) const {
    const float slope = slope_at(at);
    const auto along = static_cast<float>(u - at) + slope * (static_cast<float>(v) - centre_at(at));
    return along / std::sqrt(1.0F + slope * slope);
  }
};

}  // namespace flowdlo::testing
