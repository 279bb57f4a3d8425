// Bonds: which strand end may continue in which other one, through a crossing or across a gap,
// and at what cost.
#pragma once

#include <vector>

#include "path/strands.hpp"

namespace flowdlo::path {

struct Bond {
  int to = -1;       ///< the end that the path enters next
  float cost = 0;    ///< dimensionless; a right angle costs about 2.5
  bool gap = false;  ///< no mask in between
};

/// [2 * strands] the bonds of each end, cheapest first; symmetric up to the cut at a few an end.
/// For `several` ropes a gap may lead from one end of a strand to its other one, for there may be
/// rings, and
/// depths on both sides of a bond must fit. Of one rope the depths do not count here: each way is
/// lifted and held against the depth image as a whole, which is right more often.
[[nodiscard]] std::vector<std::vector<Bond>> make_bonds(const Strands& strands,
                                                        const Region& region, const Frame& frame,
                                                        bool several = false);

}  // namespace flowdlo::path
