// AxisLine: a stretch of a strand's axis, followed along a field's ridge.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "field/channel.hpp"

namespace flowdlo::field {

/// Pixels of the region.
struct AxisLine {
  std::vector<Eigen::Vector2f> points_px;  ///< about one pixel apart; at least two
  std::array<float, 2> tips{0, 0};         ///< [0, 1] kTip at its begin and end
  bool closed = false;                     ///< the last point is a step from the first; no tips
};

/// The axes that show, the clearest first: each ends where its strand does, passes below another
/// one, or shows no more. A strand that lies on another one is not interrupted. `field` [height,
/// width, kChannels]. Deterministic.
[[nodiscard]] std::vector<AxisLine> axis_lines(const Channels& field);

}  // namespace flowdlo::field
