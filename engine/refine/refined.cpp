#include "refine/refined.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "geometry/camera.hpp"
#include "geometry/depth.hpp"
#include "refine/local_frame.hpp"

namespace flowdlo::refine {
namespace {

float within_reach(float radii) { return std::clamp(radii, -kMostOffset, kMostOffset); }

}  // namespace

Result<Refined> refined(const Curve& curve, const Frame& frame, Network& network,
                        const field::FieldView* seen) {
  const auto strip = strip_along(curve, frame);
  if (!strip) return Refined{curve.nodes};
  const auto offsets = network.see(*strip);
  if (!offsets) return offsets.error();
  const auto frames = local_frames(curve.nodes);
  Centerline nodes = curve.nodes;
  for (std::size_t i = 0; i < kNodes; ++i) {
    const Offset& offset = (*offsets)[i];
    if (!frames[i] || !std::isfinite(offset.deep) || !std::isfinite(offset.aside)) continue;
    const Eigen::Vector3f moved = geometry::to_eigen(nodes[i]) +
                                  curve.radius_m * (within_reach(offset.deep) * frames[i]->deep +
                                                    within_reach(offset.aside) * frames[i]->aside);
    if (moved.z() > geometry::kLeastDepth_m) nodes[i] = geometry::to_point(moved);
  }
  Refined refined{nodes};
  if (seen == nullptr || network.tips() == nullptr) return refined;
  for (const bool last : {false, true}) {
    const float widths = network.tips()->beyond(tip_features(curve, last, frame, *seen));
    refined.beyond_m[last ? 1 : 0] = 2 * curve.radius_m * widths;
  }
  const Centerline whole = to_the_tips(nodes, refined.beyond_m);
  const bool usable = std::all_of(whole.begin(), whole.end(), [](const Point3& node) {
    return std::isfinite(node.x) && std::isfinite(node.y) && node.z > geometry::kLeastDepth_m;
  });
  if (!usable) return Refined{nodes};
  refined.nodes = whole;
  return refined;
}

}  // namespace flowdlo::refine
