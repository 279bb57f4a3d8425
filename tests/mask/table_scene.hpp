// TableScene: a drawn rope on a tilted table, whose mask is known pixel by pixel.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "flowdlo/frame.hpp"
#include "flowdlo/mask.hpp"
#include "random/philox.hpp"

namespace flowdlo::testing {

/// 320 x 240 px. A wavy rope from left to right, 9 px thick and 6 mm high.
struct TableScene {
  static constexpr int kWidth = 320;
  static constexpr int kHeight = 240;
  static constexpr float kRadius_px = 4.5F;
  static constexpr float kRope_m = 0.006F;

  Intrinsics camera{300, 300, 160, 120};
  std::vector<float> depth_m;
  std::vector<std::uint8_t> color_bgr;
  Mask rope;

  explicit TableScene(float noise_m = 0.0005F) {
    const std::size_t pixels = std::size_t{kWidth} * kHeight;
    depth_m.resize(pixels);
    color_bgr.resize(3 * pixels);
    rope.resize(pixels);
    for (int v = 0; v < kHeight; ++v) {
      for (int u = 0; u < kWidth; ++u) {
        const std::size_t pixel = at(u, v);
        rope[pixel] = on_rope(u, v) ? 255 : 0;
        const float height_m = rope[pixel] != 0 ? kRope_m : 0;
        depth_m[pixel] =
            table_m(u, v) * (1 - height_m / distance_m()) + noise_m * random::gaussian(7, pixel)[0];
        paint(pixel, rope[pixel] != 0 ? 200 : 120, rope[pixel] != 0 ? 30 : 120,
              rope[pixel] != 0 ? 40 : 125);
      }
    }
  }

  [[nodiscard]] static std::size_t at(int u, int v) {
    return static_cast<std::size_t>(v) * kWidth + static_cast<std::size_t>(u);
  }

  /// The row of the rope's axis in column u.
  [[nodiscard]] static float axis_v(int u) {
    return 120 + 50 * std::sin(static_cast<float>(u) / 40);
  }

  [[nodiscard]] static bool on_rope(int u, int v) {
    for (int other = std::max(30, u - 8); other <= std::min(290, u + 8); ++other) {
      const auto du = static_cast<float>(u - other);
      const float dv = static_cast<float>(v) - axis_v(other);
      if (du * du + dv * dv <= kRadius_px * kRadius_px) return true;
    }
    return false;
  }

  /// Depth of the bare table: n . p = 1 with n = (0.1, 0.5, 1.4) per metre.
  [[nodiscard]] float table_m(int u, int v) const {
    const float x = (static_cast<float>(u) - camera.cx) / camera.fx;
    const float y = (static_cast<float>(v) - camera.cy) / camera.fy;
    return 1 / (0.1F * x + 0.5F * y + 1.4F);
  }
  [[nodiscard]] static float distance_m() {
    return 1 / std::sqrt(0.1F * 0.1F + 0.5F * 0.5F + 1.4F * 1.4F);
  }

  void paint(std::size_t pixel, int red, int green, int blue) {
    color_bgr[3 * pixel] = static_cast<std::uint8_t>(blue);
    color_bgr[3 * pixel + 1] = static_cast<std::uint8_t>(green);
    color_bgr[3 * pixel + 2] = static_cast<std::uint8_t>(red);
  }

  [[nodiscard]] Frame frame() const {
    return {kWidth, kHeight, camera, depth_m, {}, color_bgr, {}};
  }
};

/// Common pixels over all pixels of two masks; 1: the same.
inline double overlap(const Mask& one, const Mask& other) {
  double common = 0;
  double all = 0;
  for (std::size_t pixel = 0; pixel < one.size(); ++pixel) {
    common += one[pixel] != 0 && other[pixel] != 0 ? 1 : 0;
    all += one[pixel] != 0 || other[pixel] != 0 ? 1 : 0;
  }
  return all > 0 ? common / all : 1;
}

inline std::size_t pixels_of(const Mask& mask) {
  return static_cast<std::size_t>(std::count(mask.begin(), mask.end(), 255));
}

}  // namespace flowdlo::testing
