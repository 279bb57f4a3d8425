// What an Estimate answers beside its fields.
#include "flowdlo/estimate.hpp"

#include <fmt/format.h>

#include "geometry/camera.hpp"
#include "geometry/smooth_curve.hpp"
#include "guard/guarded.hpp"

namespace flowdlo {
namespace {

Result<std::vector<Point3>> checked_curve(const Centerline& nodes, int points) {
  if (points < 2 || points > kMostCurvePoints) {
    return Error{
        ErrorCode::kBadInput,
        fmt::format("Estimate::curve: points: expected 2 to {}, got {}", kMostCurvePoints, points)};
  }
  for (std::size_t i = 0; i < kNodes; ++i) {
    if (geometry::to_eigen(nodes[i]).allFinite()) continue;
    return Error{ErrorCode::kBadInput,
                 fmt::format("Estimate::curve: expected finite nodes, got ({}, {}, {}) at node {}; "
                             "ask an estimate that estimate() gave",
                             nodes[i].x, nodes[i].y, nodes[i].z, i)};
  }
  return geometry::smooth_curve(nodes, points);
}

}  // namespace

Result<std::vector<Point3>> Estimate::curve(int points) const {
  return guard::guarded("Estimate::curve", [&] { return checked_curve(nodes, points); });
}

}  // namespace flowdlo
