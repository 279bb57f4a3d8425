// The nine groups of Sec. 4.1.1. The thesis names them without measures; "complicated" is read as
// strong changes of direction, stretches that stand up from the table, and many loops.
#include <utility>

#include "synth/flat_shape.hpp"
#include "synth/laid_rope.hpp"
#include "synth/rope.hpp"

namespace flowdlo::synth {
namespace {

struct Recipe {
  double least_length_m;
  double most_length_m;
  Heading heading;
  bool arches;
};

Recipe recipe_of(std::string_view scenario, Dice& dice) {
  const double turn_c = dice.uniform(1.8, 4.2);
  const double swing_s = dice.uniform(0.9, 1.7);
  if (scenario == "C") return {0.3, 0.6, {.turn = turn_c, .wander = 0.4}, false};
  if (scenario == "S") return {0.3, 0.6, {.swing = swing_s, .wander = 0.2}, false};
  if (scenario == "straight") return {0.2, 0.4, {.wander = 0.12}, false};
  if (scenario == "C-complicated") {
    return {0.35, 0.7, {.turn = turn_c, .wander = 0.4, .wiggle = 0.6}, true};
  }
  if (scenario == "S-complicated") {
    return {0.35, 0.7, {.swing = swing_s, .wander = 0.4, .wiggle = 0.6}, true};
  }
  if (scenario == "straight-complicated") {
    return {0.25, 0.45, {.wander = 0.15, .wiggle = 0.55}, true};
  }
  if (scenario == "intersection") {
    return {
        0.4, 0.8, {.turn = 5.5, .wander = 1.5, .least_crossings = 1, .most_crossings = 2}, false};
  }
  if (scenario == "intersection-complicated") {
    return {
        0.6, 1.1, {.turn = 6.5, .wander = 4.0, .least_crossings = 3, .most_crossings = 7}, false};
  }
  return {0.4,
          0.9,
          {.turn = 5.5, .wander = 3.0, .least_crossings = 1, .most_crossings = 4},
          dice.chance(0.5)};
}

}  // namespace

std::optional<Rope> try_thesis_rope(std::string_view scenario, Dice& dice) {
  const Recipe recipe = recipe_of(scenario, dice);
  Gauge gauge;
  gauge.radius_m = dice.uniform(0.003, 0.006);
  gauge.length_m = dice.uniform(recipe.least_length_m, recipe.most_length_m);
  gauge.least_bend_m = gauge.radius_m * dice.uniform(4.5, 8.0);
  const auto flat = wandering(gauge, recipe.heading, dice);
  if (!flat) return std::nullopt;
  const Laying laying{.in_order = dice.chance(0.5),
                      .arches = recipe.arches ? dice.integer(1, 2) : 0,
                      .arch_m = dice.uniform(0.01, 0.03)};
  auto curve = laid(*flat, gauge, laying, dice);
  if (!curve) return std::nullopt;
  Rope rope;
  rope.scenario = scenario;
  rope.curve = std::move(*curve);
  rope.radius_m = gauge.radius_m;
  rope.square_ends = dice.chance(0.5);
  if (!sound(rope)) return std::nullopt;
  return rope;
}

}  // namespace flowdlo::synth
