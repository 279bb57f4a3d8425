// Ends: where on the strip the centerline begins and stops.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "prior/strip.hpp"

namespace flowdlo::prior {

/// Arclengths on a strip, pixels, begin_px < end_px.
struct Extent {
  float begin_px = 0;
  float end_px = 0;
  std::array<bool, 2> tip{};  ///< of the begin and of the end: in plain sight, a cap or a cut
  float cap_doubt = 0.5F;     ///< radii that a tip in plain sight may be off, its shape unknown

  [[nodiscard]] bool holds(const Station& station) const {
    return begin_px <= station.arclength_px && station.arclength_px <= end_px;
  }
};

/// `path_px` to the rope's tips: the last width before a tip is drawn anew along the middle of the
/// mask, and what mask there is beyond an end is followed, at most three widths and not where the
/// path has passed. Ends on other strands stay as they are.
[[nodiscard]] std::vector<Eigen::Vector2f> to_the_tips(std::span<const Eigen::Vector2f> path_px,
                                                       float width_px, const Frame& frame);

/// The strip without the rope's caps: the mask of a rope with round ends reaches half a width
/// beyond its centerline, that of a rope cut off square does not; half of that where the mask does
/// not tell. Ends that are no tips (at the image's border, on another strand, where the mask goes
/// on) stay where they are.
[[nodiscard]] Extent without_caps(const Strip& strip, const Frame& frame);

}  // namespace flowdlo::prior
