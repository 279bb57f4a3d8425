// Rope crossings: where ropes pass over each other and over themselves in the image.
#pragma once

#include <vector>

#include "flowdlo/estimate.hpp"
#include "flowdlo/frame.hpp"

namespace flowdlo::estimator {

/// By `over`, then by where on it. Of two ropes that run along each other, lines which cross and
/// cross back within two widths of a rope do not cross.
[[nodiscard]] std::vector<RopeCrossing> rope_crossings(const std::vector<Estimate>& ropes,
                                                       const Frame& frame);

}  // namespace flowdlo::estimator
