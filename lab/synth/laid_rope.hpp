// LaidRope: flat shapes on a table. At a crossing the upper strand rests on the lower one.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "synth/flat_shape.hpp"

namespace flowdlo::synth {

struct FlatRope {
  FlatPoints points;
  Gauge gauge;
  bool closed = false;  ///< a ring: its last point is its first
};

struct Laying {
  bool in_order = true;  ///< later strands and ropes lie on earlier ones; else by chance
  int arches = 0;        ///< stretches where a stiff rope stands up from the table
  double arch_m = 0.02;  ///< height of the highest
};

/// x, y on the table, z upwards; the table is z = 0. Empty when the crossings are so near each
/// other that no smooth lift keeps the strands apart, or a ring would have to be lifted where it
/// begins.
[[nodiscard]] std::optional<std::vector<Curve>> laid_together(std::span<const FlatRope> ropes,
                                                              const Laying& laying, Dice& dice);

/// One rope.
[[nodiscard]] std::optional<Curve> laid(const FlatPoints& flat, const Gauge& gauge,
                                        const Laying& laying, Dice& dice);

}  // namespace flowdlo::synth
