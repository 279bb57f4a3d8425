// LocalFrame: the directions in which a node may be off beside the rope.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "flowdlo/centerline.hpp"

namespace flowdlo::refine {

/// Unit vectors, each at a right angle to the others.
struct LocalFrame {
  Eigen::Vector3f along{1, 0, 0};
  Eigen::Vector3f deep{0, 0, 1};   ///< away from the camera
  Eigen::Vector3f aside{0, 1, 0};  ///< across both rope and ray
};

/// Of each node. Nothing where nodes lie on each other, or where the rope runs along a ray.
[[nodiscard]] std::array<std::optional<LocalFrame>, kNodes> local_frames(const Centerline& nodes);

}  // namespace flowdlo::refine
