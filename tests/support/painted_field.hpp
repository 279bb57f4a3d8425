// PaintedField: what a perfect network would say of strands whose axes are known.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "field/channel.hpp"
#include "field/region.hpp"

namespace flowdlo::testing {

/// Points of a strand's axis half a pixel apart; pixels of the region.
using Axis = std::vector<Eigen::Vector2f>;

inline Axis straight_axis(const Eigen::Vector2f& from, const Eigen::Vector2f& to) {
  Axis curve;
  const int count = static_cast<int>(2 * (to - from).norm());
  for (int i = 0; i <= count; ++i) {
    curve.push_back(from + (to - from) * (static_cast<float>(i) / static_cast<float>(count)));
  }
  return curve;
}

inline Axis arc_axis(const Eigen::Vector2f& middle, float radius, float from, float to) {
  Axis curve;
  const int count = static_cast<int>(2 * radius * std::abs(to - from));
  for (int i = 0; i <= count; ++i) {
    const float angle = from + (to - from) * static_cast<float>(i) / static_cast<float>(count);
    curve.push_back(middle + radius * Eigen::Vector2f(std::cos(angle), std::sin(angle)));
  }
  return curve;
}

/// By plain numbers, as tests are compiled without optimisation: Eigen's vectors take 30 times as
/// long there.
inline std::size_t nearest_point(const Axis& curve, const Eigen::Vector2f& p) {
  const float* const places = curve.front().data();
  const std::size_t count = curve.size();
  const float x = p.x();
  const float y = p.y();
  std::size_t nearest = 0;
  float least = std::numeric_limits<float>::max();
  for (std::size_t i = 0; i < count; ++i) {
    const float du = places[2 * i] - x;
    const float dv = places[2 * i + 1] - y;
    const float squared = du * du + dv * dv;
    if (squared >= least) continue;
    least = squared;
    nearest = i;
  }
  return nearest;
}

/// What a perfect network says of strands, the lowest first. `width_px` of all of them.
inline field::Channels painted_field(const std::vector<Axis>& axes,
                                     const image::Size& size = {160, 160},
                                     float width_px = field::kRope_px) {
  field::Channels painted(size, {});
  for (int v = 0; v < painted.height(); ++v) {
    for (int u = 0; u < painted.width(); ++u) {
      const Eigen::Vector2f p(static_cast<float>(u), static_cast<float>(v));
      auto& at = painted.at(v, u);
      for (const Axis& curve : axes) {
        const std::size_t nearest = nearest_point(curve, p);
        const float off = (curve[nearest] - p).norm();
        const bool covers = off <= 0.5F * width_px;
        if (!covers && at[field::kRope] > 0) continue;
        const std::size_t next = std::min(nearest + 1, curve.size() - 1);
        const Eigen::Vector2f along = curve[next] - curve[next - 1];
        const float angle = std::atan2(along.y(), along.x());
        const float near = off / (field::kCentreWidths * width_px);
        const float centre = std::exp(-near * near);
        if (!covers && centre < at[field::kCentre]) continue;
        at[field::kCentre] = centre;
        at[field::kCos] = std::cos(2 * angle);
        at[field::kSin] = std::sin(2 * angle);
        at[field::kWidth] = std::log2(width_px / field::kRope_px);
        at[field::kRope] = covers ? 1.0F : 0.0F;
      }
    }
  }
  return painted;
}

inline void show_tip(field::Channels& painted, const Eigen::Vector2f& tip) {
  for (int v = 0; v < painted.height(); ++v) {
    for (int u = 0; u < painted.width(); ++u) {
      const float near =
          (Eigen::Vector2f(static_cast<float>(u), static_cast<float>(v)) - tip).norm() /
          (field::kTipWidths * field::kRope_px);
      float& at = painted.at(v, u)[field::kTip];
      at = std::max(at, std::exp(-near * near));
    }
  }
}

}  // namespace flowdlo::testing
