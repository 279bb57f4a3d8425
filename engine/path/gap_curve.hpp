// Gap curve: how the rope may run from one strand's end to another's where no mask shows it. Of the
// cubics that leave one end along its direction and enter the other against its own, the best.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "path/cover.hpp"
#include "path/strands.hpp"

namespace flowdlo::path {

/// What it takes to run from end to end, dimensionless: length, change of curvature, and most of
/// all running where the sensor sees the background. What costs `most` or more need not be known
/// any better than that.
[[nodiscard]] float gap_cost(const StrandEnd& from, const StrandEnd& to, const Cover& cover,
                             float scale_px, float most);

/// Points about a pixel apart on the curve that bends least for its length and keeps out of sight;
/// both ends left out.
[[nodiscard]] std::vector<Eigen::Vector2f> gap_points(const StrandEnd& from, const StrandEnd& to,
                                                      const Cover& cover, float scale_px);

}  // namespace flowdlo::path
