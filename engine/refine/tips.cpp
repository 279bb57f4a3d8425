#include "refine/tips.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "field/channel.hpp"
#include "geometry/camera.hpp"
#include "geometry/depth.hpp"
#include "geometry/pixel.hpp"
#include "geometry/polyline.hpp"
#include "geometry/smooth_curve.hpp"

namespace flowdlo::refine {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

static_assert(kTipFeatures == weights::kTipInputs);

constexpr float kPlacesFrom = -1.5F;  // widths beyond the end
constexpr float kPlaceSpacing = 0.5F;
constexpr float kDirectionRadii = 4;  // length over which an end's direction is taken,
constexpr float kBeforeRadii = 12;    // and the one before it
constexpr float kDeepestRadii = 200;
constexpr int kPiecesOfSegment = 4;                     // of the curve that is cut or drawn on
constexpr int kDirectionPieces = 2 * kPiecesOfSegment;  // before an end, on which it goes on
constexpr float kMostCut = 0.33F;

/// The nodes as they are met from one end on.
class Inwards {
 public:
  Inwards(const Centerline& nodes, bool last) : nodes_(nodes), last_(last) {}

  [[nodiscard]] std::size_t index(std::size_t i) const { return last_ ? kNodes - 1 - i : i; }
  [[nodiscard]] Vector3f at(std::size_t i) const { return geometry::to_eigen(nodes_[index(i)]); }

  /// The first node that is that far along the rope; the other end's where none is.
  [[nodiscard]] std::size_t after(float length_m) const {
    std::size_t i = 1;
    float walked_m = (at(1) - at(0)).norm();
    while (i + 1 < kNodes && walked_m < length_m) {
      ++i;
      walked_m += (at(i) - at(i - 1)).norm();
    }
    return i;
  }

 private:
  const Centerline& nodes_;
  bool last_;
};

/// From `b` to `a`; nothing where they are one.
Vector3f direction(const Vector3f& a, const Vector3f& b) {
  const Vector3f d = a - b;
  return d.norm() > 0 ? Vector3f(d.normalized()) : Vector3f(0, 0, 0);
}

float log_of(float value, float unit, float most) {
  return std::clamp(std::log(std::max(value, 1e-6F) / unit), -most, most);
}

/// What shows at a place, by plane.
std::array<float, kTipPlanes> shown_at(const Vector2f& p, float end_m, float radius_m,
                                       const Frame& frame, const field::FieldView& seen) {
  std::array<float, kTipPlanes> shown{};
  const int u = geometry::nearest_px(p.x());
  const int v = geometry::nearest_px(p.y());
  if (u < 0 || v < 0 || u >= frame.width || v >= frame.height) {
    shown[kTipMeasured] = -1;
    return shown;
  }
  const std::size_t pixel = static_cast<std::size_t>(v) * static_cast<std::size_t>(frame.width) +
                            static_cast<std::size_t>(u);
  shown[kTipMasked] = frame.mask[pixel] > 127 ? 1.0F : 0.0F;
  const float depth_m = frame.depth_m[pixel];
  if (geometry::measured(depth_m)) {
    const float deeper = (depth_m - end_m) / radius_m;
    shown[kTipMeasured] = 1;
    shown[kTipDeeper] = 0.5F * std::asinh(std::clamp(deeper, -kDeepestRadii, kDeepestRadii));
  }
  shown[kTipRope] = seen.at(p, field::kRope);
  shown[kTipLike] = seen.at(p, field::kTip);
  return shown;
}

}  // namespace

TipFeatures tip_features(const Curve& curve, bool last, const Frame& frame,
                         const field::FieldView& seen) {
  const Inwards nodes(curve.nodes, last);
  const float radius_m = curve.radius_m;
  const Vector3f end = nodes.at(0);
  const std::size_t near = nodes.after(kDirectionRadii * radius_m);
  const Vector3f out = direction(end, nodes.at(near));
  const Vector3f before = direction(nodes.at(near), nodes.at(nodes.after(kBeforeRadii * radius_m)));
  const float width_px = std::max(1.0F, 2 * radius_m * frame.intrinsics.fx / end.z());
  const Vector2f px = geometry::project(frame.intrinsics, geometry::to_point(end));
  const Vector2f chord_px =
      px - geometry::project(frame.intrinsics, geometry::to_point(nodes.at(near)));
  const Vector2f along = chord_px.norm() > 0 ? Vector2f(chord_px.normalized()) : Vector2f(1, 0);
  const float chord_m = std::max(1e-6F, (end - nodes.at(near)).norm());
  const float unseen_m = curve.unseen_m[nodes.index(0)];

  TipFeatures features{};
  features[kTipOne] = 1;
  features[kTipWidth] = 0.5F * std::log2(width_px / 8);
  features[kTipUnseen] = std::clamp(unseen_m / (20 * radius_m), 0.0F, 1.0F);
  features[kTipUnsupported] = unseen_m > 0 ? 1.0F : 0.0F;
  features[kTipSigma] = 0.5F * log_of(curve.sigma_m[nodes.index(0)], radius_m, 4);
  features[kTipSlope] = out.dot(end.normalized());
  features[kTipBend] = std::acos(std::clamp(out.dot(before), -1.0F, 1.0F));
  features[kTipForeshort] =
      std::clamp(chord_px.norm() / width_px * 2 * radius_m / chord_m, 0.0F, 2.0F);
  features[kTipDistance] = std::log(std::clamp(end.z(), 0.05F, 20.0F));
  features[kTipAhead] = seen.tip_ahead(px, along);
  features[kTipLength] = log_of(geometry::length(curve.nodes), radius_m, 12) / 4 - 1;
  features[kTipNoise] = 0.5F * log_of(curve.noise_m + 1e-4F, 1e-3F, 4);
  features[kTipRadius] = log_of(radius_m, 4e-3F, 6);

  const Vector2f across(-along.y(), along.x());
  for (std::size_t place = 0; place < kTipPlaces; ++place) {
    const float widths = kPlacesFrom + kPlaceSpacing * static_cast<float>(place);
    for (std::size_t aside = 0; aside < kTipAsides; ++aside) {
      const float off = 0.5F * static_cast<float>(aside);
      for (const float side : {-1.0F, 1.0F}) {
        const Vector2f p = px + width_px * (widths * along + side * off * across);
        const auto shown = shown_at(p, end.z(), radius_m, frame, seen);
        for (std::size_t plane = 0; plane < kTipPlanes; ++plane) {
          features[kTipColumns + (plane * kTipAsides + aside) * kTipPlaces + place] +=
              0.5F * shown[plane];
        }
      }
    }
  }
  for (float& value : features) value = std::isfinite(value) ? value : 0;
  return features;
}

float TipNetwork::beyond(const TipFeatures& features) const {
  const float widths = kTipUnit * std::sinh(std::clamp(says_(features), -9.0F, 9.0F));
  return std::isfinite(widths) ? std::clamp(widths, -kMostBefore, kMostBeyond) : 0;
}

Centerline to_the_tips(const Centerline& nodes, const std::array<float, 2>& beyond_m) {
  std::vector<Vector3f> points;
  constexpr int kPoints = kPiecesOfSegment * (static_cast<int>(kNodes) - 1) + 1;
  for (const Point3& point : geometry::smooth_curve(nodes, kPoints)) {
    points.push_back(geometry::to_eigen(point));
  }
  const float length_m = geometry::cumulative_length(points).back();
  for (const bool last : {false, true}) {
    const float change_m = beyond_m[last ? 1 : 0];
    std::reverse(points.begin(), points.end());  // the end in question comes last
    if (change_m > 0) {
      const Vector3f out = direction(points.back(), points[points.size() - 1 - kDirectionPieces]);
      points.push_back(points.back() + change_m * out);
      continue;
    }
    float left_m = std::min(-change_m, kMostCut * length_m);
    while (points.size() > 2) {
      const Vector3f step = points[points.size() - 2] - points.back();
      if (step.norm() > left_m) {
        if (step.norm() > 0) points.back() += left_m / step.norm() * step;
        break;
      }
      left_m -= step.norm();
      points.pop_back();
    }
  }
  const std::vector<Vector3f> even = geometry::resample(points, static_cast<int>(kNodes));
  Centerline result{};
  std::transform(even.begin(), even.end(), result.begin(),
                 [](const Vector3f& p) { return geometry::to_point(p); });
  return result;
}

}  // namespace flowdlo::refine
