// Association: where along the path each visible point lies, the s-hat of Eq. (3.3).
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace flowdlo::prior {

/// A visible point in the image.
struct Sighting {
  Eigen::Vector2f position_px{0, 0};
  float depth_m = 0;
};

/// [P] arclength of each sighting on the path, pixels; below zero when no part of the path lies
/// within `radius_px` of it. Where several strands do (stretches of path more than
/// `arc_window_px` apart along it), depth decides: see association.cpp. Deterministic.
/// `arclength_px` is geometry::cumulative_length(path_px).
[[nodiscard]] std::vector<float> associate(std::span<const Eigen::Vector2f> path_px,
                                           std::span<const float> arclength_px,
                                           std::span<const Sighting> sightings, float radius_px,
                                           float arc_window_px);

}  // namespace flowdlo::prior
