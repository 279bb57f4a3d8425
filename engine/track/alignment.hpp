// Alignment: how a rope's nodes have to be told so that they run as those of a frame before.
#pragma once

#include <cstddef>

#include "flowdlo/centerline.hpp"
#include "flowdlo/estimate.hpp"

namespace flowdlo::track {

/// Node i of what is told is node `first` + i of what was found, or `first` - i where `reversed`,
/// modulo the number of nodes.
struct Alignment {
  std::size_t first = 0;
  bool reversed = false;
  double apart_m = 0;  ///< mean distance of the nodes; not finite where a node is not

  [[nodiscard]] std::size_t found(std::size_t told) const {
    return (first + (reversed ? kNodes - told : told)) % kNodes;
  }
};

/// The alignment of least distance; of those that are equally near, the one that changes less. Of a
/// rope with two ends, its nodes as they are or from the other end.
[[nodiscard]] Alignment align(const Centerline& found, bool closed, const Centerline& known);

/// Nodes, support and sigma_m as the alignment tells them. `reversed` is set where it is.
void turn(Estimate& estimate, const Alignment& alignment);

/// Where on the rope, metres from node 0, a place lies that was `at_m` from it before the turn.
/// `nodes` are those before the turn.
[[nodiscard]] double turned_m(double at_m, const Centerline& nodes, bool closed,
                              const Alignment& alignment);

}  // namespace flowdlo::track
