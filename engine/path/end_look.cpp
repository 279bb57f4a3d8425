#include "path/end_look.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "geometry/pixel.hpp"
#include "geometry/quantile.hpp"

namespace flowdlo::path {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr float kFromWidths = 1.0F;
constexpr float kToWidths = 9.0F;
constexpr int kSamples = 24;
constexpr float kColorNoise = 12.0F;  // of one rope's colour along it, beside its own spread

void measure_color(const std::vector<Vector2f>& places, const Region& region, const Frame& frame,
                   EndLook& look) {
  if (frame.color_bgr.empty()) return;
  std::array<std::vector<float>, 3> channels;
  for (const Vector2f& p : places) {
    const int u = geometry::nearest_px(p.x()) + region.offset_px.x;
    const int v = geometry::nearest_px(p.y()) + region.offset_px.y;
    if (u < 0 || v < 0 || u >= frame.width || v >= frame.height) continue;
    const std::size_t pixel = static_cast<std::size_t>(v) * static_cast<std::size_t>(frame.width) +
                              static_cast<std::size_t>(u);
    for (std::size_t c = 0; c < channels.size(); ++c) {
      channels[c].push_back(static_cast<float>(frame.color_bgr[3 * pixel + c]));
    }
  }
  if (channels[0].empty()) return;
  Vector3f spread;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const auto axis = static_cast<Eigen::Index>(c);
    look.color_bgr[axis] = geometry::median_of(channels[c]);
    for (float& value : channels[c]) value = std::abs(value - look.color_bgr[axis]);
    spread[axis] = geometry::median_of(channels[c]);
  }
  look.color_spread = spread.norm();
}

}  // namespace

EndLook look_of(const std::vector<Vector2f>& points, float scale_px, const Region& region,
                const Frame& frame, const field::FieldView& seen) {
  const auto count = static_cast<int>(points.size());
  const int first = std::min(static_cast<int>(kFromWidths * scale_px), count / 4);
  const int last = std::min(count - first, static_cast<int>(kToWidths * scale_px) + 1);
  const int step = std::max(1, (last - first) / kSamples);
  std::vector<Vector2f> places;
  for (int i = first; i < last; i += step) places.push_back(points[i]);
  EndLook look;
  std::vector<float> widths;
  const Vector2f offset = offset_of(region);
  for (const Vector2f& p : places) {
    const float width = seen.width_px(p + offset);
    if (width > 0) widths.push_back(width);
  }
  if (!widths.empty()) look.width_px = geometry::median_of(widths);
  measure_color(places, region, frame, look);
  return look;
}

float color_misfit(const EndLook& a, const EndLook& b) {
  if (a.color_spread < 0 || b.color_spread < 0) return 0;
  const float brighter = std::max(a.color_bgr.norm(), b.color_bgr.norm());
  if (brighter <= 0) return 0;
  // How far the darker one's colour is from the line of all that light makes of the brighter one's.
  const float off = a.color_bgr.cross(b.color_bgr).norm() / brighter;
  const float ratio = off / (kColorNoise + a.color_spread + b.color_spread);
  return 1 - std::exp(-0.5F * ratio * ratio);
}

}  // namespace flowdlo::path
