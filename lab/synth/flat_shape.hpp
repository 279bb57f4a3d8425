// FlatShape: how a rope lies in a plane. Bends are never tighter than asked; strands come near each
// other only where they cross, or where the shape is about strands that touch.
#pragma once

#include <optional>
#include <vector>

#include "synth/curve.hpp"
#include "synth/dice.hpp"

namespace flowdlo::synth {

/// Measures every shape needs, metres.
struct Gauge {
  double length_m = 0.6;
  double radius_m = 0.004;
  double least_bend_m = 0.02;  ///< radius of the tightest bend
};

/// How a rope's heading changes along it.
struct Heading {
  double turn = 0;    ///< of the whole rope, radians, to either side
  double swing = 0;   ///< amplitude of one S, radians
  double wander = 0;  ///< amplitude of random slow waves, radians
  double wiggle = 0;  ///< amplitude of waves that are a tenth to a quarter of the rope, radians
  int least_crossings = 0;
  int most_crossings = 0;
};

using FlatPoints = std::vector<Vector2d>;

/// Samples half a radius or less apart. Empty when no attempt had as many crossings as asked,
/// steep enough, with free ends, and strands apart elsewhere.
[[nodiscard]] std::optional<FlatPoints> wandering(const Gauge& gauge, const Heading& heading,
                                                  Dice& dice);

/// A gently bent line with so many loops, each as a rope has it that was turned once around.
/// Otherwise as wandering(); flat crossings are rarer than there.
[[nodiscard]] std::optional<FlatPoints> looped(const Gauge& gauge, int loops, Dice& dice);

/// Two strands side by side, touching, with a turn at one end: a hairpin. With `roomy`, the turn
/// is wide and the strands part again before the ends.
[[nodiscard]] FlatPoints doubled(const Gauge& gauge, bool roomy, Dice& dice);

/// A flat spiral of two to three turns, its inner end inside and a tail outside.
[[nodiscard]] FlatPoints coil(const Gauge& gauge, Dice& dice);

/// A ring whose ends touch, tip to tip or side by side.
[[nodiscard]] FlatPoints ring(const Gauge& gauge, Dice& dice);

}  // namespace flowdlo::synth
