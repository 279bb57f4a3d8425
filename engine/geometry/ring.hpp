// Ring: a closed centerline, whose node 63 lies where node 0 does. It begins nowhere, so that two
// of them can only be held against each other once one of them is told as the other is.
#pragma once

#include <array>
#include <cstddef>

#include "flowdlo/centerline.hpp"

namespace flowdlo::geometry {

struct ToldRing {
  Centerline nodes{};                      ///< evenly spaced, once round: the last is the first
  std::array<std::size_t, kNodes> from{};  ///< the node that each was nearest to along the ring,
                                           ///< where those were evenly spaced as well
  bool reversed = false;                   ///< it is told the other way round
  double begins = 0;  ///< [0, 1) how far round the ring, told the way it was, the first lies
};

/// The ring from that place on and that way round from which its nodes are nearest to those of the
/// same index of `other`, to a quarter of their spacing. Both are finite. Where the last node of
/// `ring` is short of its first, the ring goes on to that.
[[nodiscard]] ToldRing told_like(const Centerline& ring, const Centerline& other);

/// Mean distance of nodes of the same index, metres: whichever end of `b` comes first, and of
/// `rings` wherever they begin.
[[nodiscard]] double mean_distance(const Centerline& a, const Centerline& b, bool rings);

}  // namespace flowdlo::geometry
