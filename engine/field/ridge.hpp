// Ridge: the axes of strands, where a field's nearness is largest across its direction.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "field/channel.hpp"

namespace flowdlo::field {

/// A point on an axis; pixels of the region.
struct RidgePoint {
  Eigen::Vector2f px;
  float angle = 0;     ///< radians from u towards v; a line's, without sense
  float nearness = 0;  ///< kCentre there
};

/// Least kCentre of a ridge.
inline constexpr float kRidge = 0.4F;

/// One pixel or two across, along every strand that shows.
[[nodiscard]] std::vector<RidgePoint> ridges(const Channels& field, float least = kRidge);

/// Least kTip of an end.
inline constexpr float kTipPeak = 0.7F;

/// Where tips are likeliest; pixels of the region.
[[nodiscard]] std::vector<Eigen::Vector2f> tips(const Channels& field, float least = kTipPeak);

}  // namespace flowdlo::field
