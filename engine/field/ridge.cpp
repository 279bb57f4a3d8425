#include "field/ridge.hpp"

#include <algorithm>
#include <cmath>

#include "field/channel.hpp"
#include "field/region.hpp"
#include "field/surface.hpp"

namespace flowdlo::field {
std::vector<RidgePoint> ridges(const Channels& field, float least) {
  const Surface surface(field);
  std::vector<RidgePoint> found;
  field.for_rows([&](int v, int first, const auto* row, int count) {
    for (int u = first; u < first + count; ++u) {
      const auto& at = row[u - first];
      if (at[kCentre] < least) continue;
      const float angle = 0.5F * std::atan2(at[kSin], at[kCos]);
      const float across_u = -std::sin(angle);
      const float across_v = std::cos(angle);
      const auto x = static_cast<float>(u);
      const auto y = static_cast<float>(v);
      const float here = at[kCentre];
      const float left = surface.at({x + across_u, y + across_v}, kCentre);
      const float right = surface.at({x - across_u, y - across_v}, kCentre);
      if (here < left || here <= right) continue;
      // The top of the parabola through all three.
      const float bend = left + right - 2 * here;
      const float shift = bend < 0 ? std::clamp(0.5F * (right - left) / bend, -0.5F, 0.5F) : 0.0F;
      found.push_back({{x + shift * across_u, y + shift * across_v}, angle, here});
    }
  });
  return found;
}

std::vector<Eigen::Vector2f> tips(const Channels& field, float least) {
  constexpr int kAlone_px = static_cast<int>(kRope_px / 2);  // no other tip within this
  std::vector<Eigen::Vector2f> found;
  field.for_rows([&](int v, int first, const auto* row, int count) {
    for (int u = first; u < first + count; ++u) {
      const float here = row[u - first][kTip];
      if (here < least) continue;
      bool highest = true;
      for (int y = std::max(0, v - kAlone_px); y <= std::min(field.height() - 1, v + kAlone_px);
           ++y) {
        for (int x = std::max(0, u - kAlone_px); x <= std::min(field.width() - 1, u + kAlone_px);
             ++x) {
          const float other = field.at(y, x)[kTip];
          const bool before = y < v || (y == v && x < u);  // of equals the first
          highest = highest && (before ? other < here : other <= here);
        }
      }
      if (highest) found.emplace_back(static_cast<float>(u), static_cast<float>(v));
    }
  });
  return found;
}

}  // namespace flowdlo::field
