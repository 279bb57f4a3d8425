// Alignment: how a rope's nodes have to be told so that they run as those of a frame before.
#pragma once

#include <array>
#include <cstddef>

#include "flowdlo/centerline.hpp"
#include "flowdlo/estimate.hpp"

namespace flowdlo::track {

struct Alignment {
  Centerline nodes{};                      ///< as they are told
  std::array<std::size_t, kNodes> from{};  ///< the node that each was; of a ring the nearest one
  bool reversed = false;
  double begins = 0;   ///< [0, 1) of a ring: how far round, told the way it was, the first lies
  double apart_m = 0;  ///< mean distance of the nodes; not finite where a node is not
};

/// The alignment of least distance; of those that are equally near, the one that changes less. Of a
/// rope with two ends, its nodes as they are or from the other end; of a ring, evenly spaced from
/// where it is nearest (geometry/ring.hpp). As they are where a node is not finite.
[[nodiscard]] Alignment align(const Centerline& found, bool closed, const Centerline& known);

/// Nodes, support and sigma_m as the alignment tells them; each alternative, for itself, from that
/// of its ends from which it is nearer to `known`. `reversed` is set where the alignment is.
void turn(Estimate& estimate, const Alignment& alignment, const Centerline& known);

/// Where on the rope, metres from node 0, a place lies that was `at_m` from it before the turn.
/// `nodes` are those before the turn.
[[nodiscard]] double turned_m(double at_m, const Centerline& nodes, bool closed,
                              const Alignment& alignment);

}  // namespace flowdlo::track
