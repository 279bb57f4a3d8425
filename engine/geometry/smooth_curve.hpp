// SmoothCurve: the curve that 64 nodes stand for, as densely as wanted.
#pragma once

#include <vector>

#include "flowdlo/centerline.hpp"

namespace flowdlo::geometry {

/// [points, 3] uniform in arclength on a curve with continuous tangents through every node, from
/// the first to the last, which are its ends exactly. Nodes in one place count once; where all are,
/// so are the points. Expects finite nodes and two points at least; all of them are finite.
[[nodiscard]] std::vector<Point3> smooth_curve(const Centerline& nodes, int points);

}  // namespace flowdlo::geometry
