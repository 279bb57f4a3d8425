// LaidRope: a flat shape on a table. At a crossing the upper strand rests on the lower one.
#pragma once

#include <optional>

#include "synth/flat_shape.hpp"

namespace flowdlo::synth {

struct Laying {
  bool in_order = true;  ///< later strands lie on earlier ones, as a rope is laid; else by chance
  int arches = 0;        ///< stretches where a stiff rope stands up from the table
  double arch_m = 0.02;  ///< height of the highest
};

/// x, y on the table, z upwards; the table is z = 0. Empty when the crossings are so near each
/// other that no smooth lift keeps the strands apart.
[[nodiscard]] std::optional<Curve> laid(const FlatPoints& flat, const Gauge& gauge,
                                        const Laying& laying, Dice& dice);

}  // namespace flowdlo::synth
