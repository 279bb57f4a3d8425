// A mask drawn by hand, and paths over it.
#pragma once

#include <cstdint>
#include <vector>

#include "prior/strip.hpp"

namespace flowdlo::prior::testing {

using Points = std::vector<Eigen::Vector2f>;

inline constexpr int kWidth = 320;
inline constexpr int kHeight = 240;

/// A mask drawn by hand; depth 0.5 m wherever it is set.
struct Sheet {
  std::vector<std::uint8_t> mask = std::vector<std::uint8_t>(kWidth * kHeight, 0);
  std::vector<float> depth_m = std::vector<float>(kWidth * kHeight, 0.0F);

  Sheet& box(int u0, int v0, int u1, int v1, float z = 0.5F) {
    for (int v = v0; v <= v1; ++v) {
      for (int u = u0; u <= u1; ++u) {
        mask[static_cast<std::size_t>(v * kWidth + u)] = 255;
        depth_m[static_cast<std::size_t>(v * kWidth + u)] = z;
      }
    }
    return *this;
  }
  [[nodiscard]] Frame frame() const {
    return {kWidth, kHeight, {300, 300, 160, 120}, depth_m, mask, {}};
  }
};

inline Strip strip_of(const Points& path, float width_px, const Sheet& sheet) {
  return make_strip(path, width_px, sheet.frame(), evidence::unproject(sheet.frame()));
}

// A bar 11 px wide: rows 115 to 125.
inline const Points kLevel{{20, 120}, {300, 120}};

/// Along v = 120, up, and down u = 160: crosses itself at (160, 120).
inline const Points kCross{{40, 120}, {280, 120}, {280, 30}, {160, 30}, {160, 220}};

}  // namespace flowdlo::prior::testing
