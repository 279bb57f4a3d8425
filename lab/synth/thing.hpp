// Thing: what is in the picture besides the ropes: bars, hands, grippers, clutter.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "synth/view.hpp"

namespace flowdlo::synth {

enum class ThingKind : std::uint8_t { kBar, kHand, kGripper, kClutter };

struct Capsule {
  Vector3d from;
  Vector3d to;
  double radius_m = 0.01;
};

struct Box {
  Vector3d middle;
  Eigen::Matrix3d axes;  ///< unit columns
  Vector3d half_m;       ///< along those
};

/// Camera frame.
struct Thing {
  ThingKind kind = ThingKind::kClutter;
  std::vector<Capsule> capsules;
  std::vector<Box> boxes;
  Vector3d color_bgr{128, 128, 128};
};

/// One or two bars in front of the ropes, each over an inner part of one.
void add_bars(const View& view, double radius_m, Dice& dice, std::vector<Thing>& things);

/// A hand that reaches in from the border and pinches a rope.
void add_hand(const View& view, double radius_m, Dice& dice, std::vector<Thing>& things);

/// What holds a hanging rope, which `curve` of the view is; a gripper may cover up to two
/// centimetres of the end.
void add_grippers(const View& view, const Rope& rope, const Curve& curve, Dice& dice,
                  std::vector<Thing>& things);

/// Boxes, rods and other cables on the table, or things behind hanging ropes; none touches one.
void add_clutter(const View& view, double radius_m, bool hanging, Dice& dice,
                 std::vector<Thing>& things);

}  // namespace flowdlo::synth
