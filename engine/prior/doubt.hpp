// Doubt: how far the nodes of a refined prior may be off.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "flowdlo/frame.hpp"
#include "prior/ends.hpp"
#include "prior/prior.hpp"
#include "prior/rope_depth.hpp"
#include "prior/strip.hpp"

namespace flowdlo::prior {

/// [stations] deviation of the points across the rope and in depth: noise, and more the farther the
/// nearest station is that is seen.
[[nodiscard]] std::vector<float> station_sigma_m(std::span<const Eigen::Vector3f> points_cam,
                                                 const Strip& strip, const RopeDepth& rope,
                                                 float fx);

struct Placed {
  const Strip& strip;
  const Extent& extent;  ///< free of the caps of the tips in plain sight
  const RopeDepth& rope;
  const Frame& frame;
};

/// Adds to `prior.sigma_m` how far the nodes may have slid along the rope: they are shares of its
/// length, so that an end that is off and a gap longer or shorter than bridged move all of them.
void doubt_along(const Placed& placed, std::span<const float> node_arclength_px, Prior& prior);

}  // namespace flowdlo::prior
