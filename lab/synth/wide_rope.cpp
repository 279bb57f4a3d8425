// The shapes of the wide split: what a user may lay down, coil, fold or hang up.
#include <algorithm>

#include "synth/flat_shape.hpp"
#include "synth/hanging_rope.hpp"
#include "synth/laid_rope.hpp"
#include "synth/rope.hpp"

namespace flowdlo::synth {
namespace {

constexpr double kLeastLength_m = 0.2;
constexpr double kMostLength_m = 2.0;
constexpr double kLeastRadius_m = 0.0008;
constexpr double kMostRadius_m = 0.012;

// Length and radius are drawn apart, within what makes a rope: 25 to 1500 radii, more for loops.
Gauge gauge_of(double least_slenderness, double most_slenderness, Dice& dice) {
  Gauge gauge;
  do {
    gauge.length_m = dice.log_uniform(kLeastLength_m, kMostLength_m);
    gauge.radius_m = dice.log_uniform(kLeastRadius_m, kMostRadius_m);
  } while (gauge.length_m < least_slenderness * gauge.radius_m ||
           gauge.length_m > most_slenderness * gauge.radius_m);
  gauge.least_bend_m = gauge.radius_m * dice.log_uniform(4.0, 12.0);
  return gauge;
}

Heading heading_of(std::string_view scenario, Dice& dice) {
  Heading heading;
  if (scenario == "table") {
    heading.turn = dice.uniform(0, 5);
    heading.wander = dice.uniform(0.1, 2.5);
    heading.wiggle = dice.chance(0.3) ? dice.uniform(0.1, 0.6) : 0.0;
  } else if (scenario == "crossing") {
    heading = {
        .turn = 5, .wander = dice.uniform(0.8, 3), .least_crossings = 1, .most_crossings = 1};
  } else {
    heading = {.turn = dice.uniform(4, 9),
               .wander = dice.uniform(2.5, 5),
               .least_crossings = 2,
               .most_crossings = 7};
  }
  return heading;
}

std::optional<Curve> laid_curve(std::string_view scenario, const Gauge& gauge, Dice& dice) {
  Laying laying{.in_order = dice.chance(0.5)};
  std::optional<FlatPoints> flat;
  if (scenario == "hairpin" || scenario == "side-by-side") {
    flat = doubled(gauge, scenario == "side-by-side", dice);
  } else if (scenario == "coil") {
    flat = coil(gauge, dice);
  } else if (scenario == "ends-touch") {
    flat = ring(gauge, dice);
  } else {
    flat = wandering(gauge, heading_of(scenario, dice), dice);
    if (dice.chance(0.3)) {
      laying.arches = dice.integer(1, 2);
      laying.arch_m = dice.uniform(2, 6) * gauge.radius_m + dice.uniform(0, 0.03);
    }
  }
  if (!flat) return std::nullopt;
  return laid(*flat, gauge, laying, dice);
}

}  // namespace

std::optional<Rope> try_wide_rope(std::string_view scenario, Dice& dice) {
  Rope rope;
  rope.scenario = scenario;
  const bool loops = scenario == "crossings" || scenario == "hanging-loops";
  const bool coil = scenario == "coil";
  const bool folded = scenario == "hairpin" || scenario == "side-by-side";
  const double least = coil ? 130 : loops || folded ? 90 : scenario == "table" ? 25 : 50;
  Gauge gauge = gauge_of(least, coil ? 600 : 1500, dice);
  if (folded) gauge.least_bend_m = gauge.radius_m * dice.uniform(4.0, 7.0);
  rope.radius_m = gauge.radius_m;
  rope.coil = coil;
  rope.square_ends = dice.chance(0.5);
  if (scenario == "hanging" || scenario == "hanging-loops") {
    const Hanging hanging{.two_grippers = dice.chance(0.75),
                          .loops = scenario == "hanging" ? 0 : dice.integer(1, 2),
                          .swing_m = dice.uniform(0.02, 0.25) * std::min(gauge.length_m, 1.0)};
    rope.hanging = true;
    rope.grippers = hanging.two_grippers ? 2 : 1;
    rope.curve = hung(gauge, hanging, dice);
  } else {
    auto curve = laid_curve(scenario, gauge, dice);
    if (!curve) return std::nullopt;
    rope.curve = std::move(*curve);
  }
  const double length = rope.curve.length_m();  // lifts, swings and overlaps have added to it
  if (length < kLeastLength_m || length > kMostLength_m || !sound(rope)) return std::nullopt;
  return rope;
}

}  // namespace flowdlo::synth
