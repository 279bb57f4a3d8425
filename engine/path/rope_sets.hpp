// Rope sets: the cheapest sets of ways that together explain all strands. No strand is in two ways.
#pragma once

#include <vector>

#include "path/links.hpp"
#include "path/search.hpp"
#include "path/strands.hpp"

namespace flowdlo::path {

struct RopeSet {
  std::vector<Traversal> ways;  ///< `cost` of each is 0: only that of all is known
  float cost = 0;
};

/// At most `count` sets of `ropes` ways, or with 0 of any number, cheapest first; empty where there
/// are none. A set pays for its bonds, for where its ways end, for what it leaves out, and for each
/// closed way kRingEnergy. Every end of a strand has one bond at
/// most and every strand is either used or left out, so that a set is a pairing of ends
/// (`cheapest_pairings`): exact for any number of ropes as long as that is. A number that is asked
/// for comes from the price of one more rope at which it is the cheapest one. Deterministic.
[[nodiscard]] std::vector<RopeSet> search_sets(const Strands& strands,
                                               const std::vector<std::vector<Bond>>& bonds,
                                               int ropes, std::size_t count);

}  // namespace flowdlo::path
