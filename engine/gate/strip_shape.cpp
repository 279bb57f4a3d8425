#include "gate/strip_shape.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "geometry/depth.hpp"
#include "geometry/pixel.hpp"
#include "geometry/quantile.hpp"

namespace flowdlo::gate {
namespace {

using Eigen::Vector2f;

constexpr std::uint8_t kMaskThreshold = 127;  // 0.5 of an 8-bit mask
constexpr float kWithin = 2;                  // radii from the axis to a side in sight,
constexpr float kWithin_px = 2;               // and this beyond
constexpr float kNarrowest = 0.6F;            // of the rope's width, what is as wide as it
constexpr float kWidest = 1.6F;
constexpr float kMostWidening = 2.5F;
constexpr float kBeside = 0.5F;  // radii that the curve may run beside the mask, and a pixel
constexpr float kHidden = 2;     // radii nearer than the rope's surface: an occluder
constexpr float kBehind = 0.6F;  // radii behind its surface: what the rope would hide

enum class Seen { kMask, kBackground, kOutside };

Seen seen(const Frame& frame, const Vector2f& px) {
  const int u = geometry::nearest_px(px.x());
  const int v = geometry::nearest_px(px.y());
  if (u < 0 || v < 0 || u >= frame.width || v >= frame.height) return Seen::kOutside;
  const auto pixel = static_cast<std::size_t>(v) * static_cast<std::size_t>(frame.width) +
                     static_cast<std::size_t>(u);
  return frame.mask[pixel] > kMaskThreshold ? Seen::kMask : Seen::kBackground;
}

/// Pixels from the axis to the mask's end on one side; 0 where none is in sight.
float side_px(const Frame& frame, const CurvePoint& point, const Vector2f& outwards) {
  const float most = kWithin * point.radius_px + kWithin_px;
  for (float off = 1; off <= most; off += 1) {
    switch (seen(frame, point.px + off * outwards)) {
      case Seen::kMask:
        continue;
      case Seen::kBackground:
        return off - 0.5F;
      case Seen::kOutside:
        return 0;
    }
  }
  return 0;
}

/// What is there, or beside it where the mask does not reach it.
Seen seen_near(const Frame& frame, const CurvePoint& point) {
  const Seen here = seen(frame, point.px);
  if (here != Seen::kBackground) return here;
  const Vector2f across{-point.along.y(), point.along.x()};
  const float off = kBeside * point.radius_px + 1;
  const bool near = seen(frame, point.px + off * across) == Seen::kMask ||
                    seen(frame, point.px - off * across) == Seen::kMask;
  return near ? Seen::kMask : Seen::kBackground;
}

/// Depth at a place; 0 where none was measured.
float depth_at(const Frame& frame, const Vector2f& px) {
  if (seen(frame, px) == Seen::kOutside) return 0;
  const auto pixel = static_cast<std::size_t>(geometry::nearest_px(px.y())) *
                         static_cast<std::size_t>(frame.width) +
                     static_cast<std::size_t>(geometry::nearest_px(px.x()));
  const float depth_m = frame.depth_m[pixel];
  return geometry::measured(depth_m) ? depth_m : 0;
}

struct Walk {
  int on_mask = 0;
  int sides = 0;
  std::vector<float> widths;  ///< where both sides are in sight, in the rope's
  int off_mask = 0;
  float bare_px = 0;
};

void measure_sides(const Frame& frame, const CurvePoint& point, Walk& walk) {
  const Vector2f across{-point.along.y(), point.along.x()};
  const float left_px = side_px(frame, point, across);
  const float right_px = side_px(frame, point, -across);
  ++walk.on_mask;
  walk.sides += left_px > 0 || right_px > 0 ? 1 : 0;
  if (left_px <= 0 || right_px <= 0) return;
  const float ratio = (left_px + right_px) / (2 * point.radius_px);
  walk.widths.push_back(ratio);
}

}  // namespace

StripShape strip_shape(const ImageCurve& curve, const Frame& frame) {
  Walk walk;
  float bare_from_px = -1;
  for (const CurvePoint& point : curve.points) {
    const Seen here = seen_near(frame, point);
    if (here == Seen::kMask) measure_sides(frame, point, walk);
    const float surface_m = point.depth_m - curve.radius_m;
    const float depth_m = depth_at(frame, point.px);
    const bool hidden = depth_m > 0 && depth_m < surface_m - kHidden * curve.radius_m;
    const bool bare = here == Seen::kBackground && depth_m > surface_m + kBehind * curve.radius_m;
    walk.off_mask += here == Seen::kBackground && !hidden ? 1 : 0;
    if (!bare) {
      bare_from_px = -1;
    } else if (bare_from_px < 0) {
      bare_from_px = point.length_px;
    }
    if (bare) walk.bare_px = std::max(walk.bare_px, point.length_px - bare_from_px);
  }
  const auto share = [](int part, int whole) {
    return whole > 0 ? static_cast<float>(part) / static_cast<float>(whole) : 0.0F;
  };
  const auto even = std::count_if(walk.widths.begin(), walk.widths.end(), [](float ratio) {
    return ratio > kNarrowest && ratio < kWidest;
  });
  StripShape shape;
  shape.sides = share(walk.sides, walk.on_mask);
  shape.even = share(static_cast<int>(even), static_cast<int>(walk.widths.size()));
  if (!walk.widths.empty()) {
    shape.widening = std::clamp(geometry::median_of(walk.widths), 1.0F, kMostWidening);
  }
  shape.off_mask = share(walk.off_mask, static_cast<int>(curve.points.size()));
  shape.bare_gap_widths = walk.bare_px / curve.width_px;
  return shape;
}

}  // namespace flowdlo::gate
