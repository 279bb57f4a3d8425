// SideBySide: strands that touch without crossing, each put on its own half of the mask.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "prior/strip.hpp"

namespace flowdlo::prior {

/// The strip's axis moved to where it must be. Two strands that come alongside each other and part
/// on the same sides, while the mask stays two ropes wide, have not crossed in between, whatever
/// the path did: each runs half a width beside its own edge of the mask. Nothing when no strands
/// touch so.
[[nodiscard]] std::optional<std::vector<Eigen::Vector2f>> side_by_side(const Strip& strip);

}  // namespace flowdlo::prior
