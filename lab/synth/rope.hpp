// Rope: one rope of a scenario, in its own frame, before any camera looks at it.
#pragma once

#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "synth/cord.hpp"
#include "synth/curve.hpp"
#include "synth/dice.hpp"

namespace flowdlo::synth {

struct Rope {
  std::string_view scenario;
  Curve curve;  ///< on a table: z upwards from it; hanging: x right, y down, z out of its plane
  double radius_m = 0;
  bool hanging = false;
  int grippers = 0;  ///< of a hanging rope: 1 holds its first end, 2 hold both
  bool coil = false;
  bool square_ends = false;  ///< cut square; otherwise round caps reach a radius beyond the curve
  bool closed = false;       ///< a ring: the curve's last point is its first
  std::optional<Cord> cord = std::nullopt;  ///< none: a tube in one of the thesis' materials
};

/// The ropes of a scene, longest first; all lie on the table, or all hang.
using Ropes = std::vector<Rope>;

inline constexpr std::array<std::string_view, 9> kThesisScenarios = {"C",
                                                                     "S",
                                                                     "straight",
                                                                     "intersection",
                                                                     "C-complicated",
                                                                     "S-complicated",
                                                                     "straight-complicated",
                                                                     "intersection-complicated",
                                                                     "intersection-new"};
inline constexpr std::array<std::string_view, 9> kWideScenarios = {
    "table",   "crossing",     "crossings", "hanging",   "hanging-loops",
    "hairpin", "side-by-side", "coil",      "ends-touch"};

inline constexpr std::array<std::string_view, 5> kSeveralScenarios = {
    "ropes-crossing", "ropes-touching", "ropes-hanging", "ropes-ring", "ropes-leaving"};
inline constexpr std::array<std::string_view, 4> kTangledScenarios = {
    "tangled-loops", "tangled-coils", "tangled-flat", "tangled-near"};

/// Strands at least 1.95 radii apart, no bend tighter than 3 radii; empty when an attempt failed.
[[nodiscard]] std::optional<Rope> try_thesis_rope(std::string_view scenario, Dice& dice);
[[nodiscard]] std::optional<Rope> try_wide_rope(std::string_view scenario, Dice& dice);
/// Two to nine of them; also strands of different ropes are that far apart.
[[nodiscard]] std::optional<Ropes> try_several_ropes(std::string_view scenario, Dice& dice);
/// Two to six on a table, likewise.
[[nodiscard]] std::optional<Ropes> try_tangled_ropes(std::string_view scenario, Dice& dice);

/// What every rope must be.
[[nodiscard]] bool sound(const Rope& rope);

}  // namespace flowdlo::synth
