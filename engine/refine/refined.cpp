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

Result<Centerline> refined(const Curve& curve, const Frame& frame, Network& network) {
  const auto strip = strip_along(curve, frame);
  if (!strip) return curve.nodes;
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
  return nodes;
}

}  // namespace flowdlo::refine
