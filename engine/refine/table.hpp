// Table: the plane on which a rope lies, where what is seen beside the rope is one.
//
// A depth camera that matches pictures is off by centimetres at a metre, alike over whole stretches
// of a rope, and off as much beside the rope. Over all of the rope that averages out: a plane
// through all that is seen beside the rope is many times as sure as the depth of any one place.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "flowdlo/frame.hpp"

namespace flowdlo::refine {

/// A place on the rope's axis, and how it runs there.
struct AxisPlace {
  Eigen::Vector2f px{0, 0};
  Eigen::Vector2f along{1, 0};  ///< unit
  float half_px = 0;            ///< half of the rope's width
};

/// What lies beside the rope at a place, clear of what a camera's window mixes with the rope.
struct Beside {
  int sides = 0;      ///< of the rope on which something is seen: 0 to 2
  float depth_m = 0;  ///< mean of those; 0: none
};

struct Table {
  Eigen::Vector3f plane{0, 0, 1};  ///< 1 / z of its points is this times (x / z, y / z, 1)
  float misfit = 0;     ///< typical, of the inverse depths, 1 / m: 1.4826 times the median
  float roughness = 0;  ///< the same of what misfits a window apart differ by, over sqrt(2)
  float known = 0;      ///< (0, 1] share of the places beside which something was seen
};

/// `beside` [places] is filled. Nothing where too little is seen beside the rope.
[[nodiscard]] std::optional<Table> table_beside(std::span<const AxisPlace> places,
                                                const Frame& frame, std::span<Beside> beside);

/// What to multiply `point_cam` by, along its ray, so that the axis of a rope of that radius lies
/// on the table there; nothing where the table is seen too flatly.
[[nodiscard]] std::optional<float> share_to(const Table& table, const Eigen::Vector3f& point_cam,
                                            float radius_m);

}  // namespace flowdlo::refine
