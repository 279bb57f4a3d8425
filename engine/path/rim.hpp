// Rim: where an occluder cut the rope lengthwise, one side of it shows and the other does not.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "path/cover.hpp"

namespace flowdlo::path {

/// Points in the middle of a mask that an occluder made narrow move to the middle of the rope: half
/// a width inwards from the rim that shows. Returns [points] 1 for those that did; they may lie off
/// the mask then. Expects points about a pixel apart.
std::vector<std::uint8_t> centre_on_rim(std::vector<Eigen::Vector2f>& points, const Cover& cover,
                                        float width_px);

}  // namespace flowdlo::path
