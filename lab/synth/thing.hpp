// Thing: what is in the picture besides the rope: bars, hands, grippers, clutter.
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

/// One or two bars in front of the rope, each over an inner part of it.
void add_bars(const View& view, double radius_m, Dice& dice, std::vector<Thing>& things);

/// A hand that reaches in from the border and pinches the rope.
void add_hand(const View& view, double radius_m, Dice& dice, std::vector<Thing>& things);

/// What holds a hanging rope; a gripper may cover up to two centimetres of the end.
void add_grippers(const View& view, const Rope& rope, Dice& dice, std::vector<Thing>& things);

/// Boxes, rods and other cables on the table, or things behind a hanging rope; none touches it.
void add_clutter(const View& view, const Rope& rope, Dice& dice, std::vector<Thing>& things);

}  // namespace flowdlo::synth
