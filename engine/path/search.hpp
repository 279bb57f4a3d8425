// Search: the cheapest ways through all strands, end to end. A traversal pays for its bonds, for
// ends that are no tips, and for the length it leaves uncovered.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "path/links.hpp"
#include "path/strands.hpp"

namespace flowdlo::path {

struct Traversal {
  std::vector<int> enters;  ///< the end by which each strand is entered, in order
  float cost = 0;
  bool closed = false;  ///< from the last strand on to the first one: a ring
};

/// At most `count` distinct traversals, cheapest first; a traversal and its reverse are one. Where
/// `ends` of the rope are known, in the strands' pixels, an end there costs nothing, and one
/// elsewhere as much as it would without them and kElsewhere more.
/// Exact (best first with a bound that never overestimates) unless the mask has so many crossings
/// that the work would not be bounded; a beam search answers then. Deterministic.
[[nodiscard]] std::vector<Traversal> search(const Strands& strands,
                                            const std::vector<std::vector<Bond>>& bonds, int count,
                                            const std::vector<Eigen::Vector2f>& ends = {});

inline constexpr float kElsewhere = 6;  ///< what an end costs that lies far from all known ones

}  // namespace flowdlo::path
