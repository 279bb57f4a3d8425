#include "refine/refined.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "geometry/camera.hpp"
#include "geometry/depth.hpp"
#include "geometry/polyline.hpp"
#include "refine/local_frame.hpp"

namespace flowdlo::refine {
namespace {

// Of a known length, chosen on 3,331 `wide` training scenes (docs/hints.md): how well it is known
// and measured; what lacks more than the other is another way's length.
constexpr float kLengthTolerance = 0.01F;
constexpr float kMostLacking = 0.5F;
// What lacks is shared out by the fourth power of how far a tip is from being shown in full.
constexpr float kShown = 1.05F;

float within_reach(float radii) { return std::clamp(radii, -kMostOffset, kMostOffset); }

/// What a curve of that length lacks of the known one, beyond the tolerance.
float lacking_m(float length_m, float known_m) {
  const float lacking_m = (1 - kLengthTolerance) * known_m - length_m;
  return lacking_m > 0 && lacking_m < kMostLacking * known_m ? lacking_m : 0;
}

}  // namespace

Refined with_tips(const Curve& curve, const Centerline& nodes, const Frame& frame,
                  const Network& network, const EndsKnown& ends) {
  Refined refined{nodes};
  if (!can_be_seen(curve)) return refined;
  const bool seen = ends.seen != nullptr && network.tips() != nullptr;
  std::array<float, 2> hidden{};
  for (const std::size_t end : {0U, 1U}) {
    refined.beyond_m[end] = ends.tip_m[end].value_or(0);
    if (ends.tip_m[end] || !seen) continue;
    const TipFeatures features = tip_features(curve, end == 1, frame, *ends.seen);
    refined.beyond_m[end] = 2 * curve.radius_m * network.tips()->beyond(features);
    hidden[end] = std::pow(kShown - features[kTipAhead], 4.0F);
  }
  const float length_m = geometry::length(nodes) + refined.beyond_m[0] + refined.beyond_m[1];
  const float lacking = lacking_m(length_m, static_cast<float>(ends.rope_length_m));
  for (const std::size_t end : {0U, 1U}) {
    if (hidden[end] > 0) {
      refined.beyond_m[end] += lacking * hidden[end] / (hidden[0] + hidden[1]);
    }
  }
  if (refined.beyond_m[0] == 0 && refined.beyond_m[1] == 0) return Refined{nodes};
  const Centerline whole = to_the_tips(nodes, refined.beyond_m);
  const bool usable = std::all_of(whole.begin(), whole.end(), [](const Point3& node) {
    return std::isfinite(node.x) && std::isfinite(node.y) && node.z > geometry::kLeastDepth_m;
  });
  if (!usable) return Refined{nodes};
  refined.nodes = whole;
  return refined;
}

Result<Refined> refined(const Curve& curve, const Frame& frame, Network& network,
                        const EndsKnown& ends) {
  const auto strip = strip_along(curve, frame);
  if (!strip) return Refined{curve.nodes};
  const auto offsets = network.see(*strip);
  if (!offsets) return offsets.error();
  const auto frames = local_frames(curve.nodes);
  Centerline nodes = curve.nodes;
  for (std::size_t i = 0; i < kNodes; ++i) {
    const Offset& offset = (*offsets)[i];
    if (!frames[i] || !std::isfinite(offset.deep) || !std::isfinite(offset.aside) ||
        !std::isfinite(offset.laid)) {
      continue;
    }
    const float share = 1 + offset.laid * (strip->table_share[i] - 1);
    const Eigen::Vector3f moved = share * geometry::to_eigen(nodes[i]) +
                                  curve.radius_m * (within_reach(offset.deep) * frames[i]->deep +
                                                    within_reach(offset.aside) * frames[i]->aside);
    if (moved.z() > geometry::kLeastDepth_m) nodes[i] = geometry::to_point(moved);
  }
  return with_tips(curve, nodes, frame, network, ends);
}

}  // namespace flowdlo::refine
