// Search: the cheapest sets of ways that together explain all strands, and the cheapest way of one
// rope. No strand is in two ways.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "path/links.hpp"
#include "path/strands.hpp"

namespace flowdlo::path {

/// A way through strands, end to end.
struct Traversal {
  std::vector<int> enters;  ///< the end by which each strand is entered, in order
  float cost = 0;           ///< with all other strands left out; 0 of a way in a set
  bool closed = false;      ///< from the last strand on to the first one: a ring
};

struct RopeSet {
  std::vector<Traversal> ways;
  float cost = 0;
};

/// At most `count` sets of `ropes` ways, or with 0 of any number, cheapest first; empty where there
/// are none. A set pays for its bonds, for where its ways end, for what it leaves out, kRingEnergy
/// for each ring that bonds close, and kTouchEnergy where two bonds touch. Every end of a strand
/// has one bond at most and every strand is either used or left out, so that a set is a pairing of
/// ends (`cheapest_pairings`): exact for any number of ropes as long as that is. A number that is
/// asked for comes from the price of one more rope at which it is the cheapest one; one that is so
/// at no price is looked for on both sides of where it is passed. Of each of these sets the ways
/// then go that others lie on (path/overlaps): what is left out pays nothing where a strand that is
/// used explains it. Deterministic.
[[nodiscard]] std::vector<RopeSet> search_sets(const Strands& strands, const Prices& prices,
                                               int ropes, std::size_t count);

/// At most `count` ways of one rope that has two ends, cheapest first; a way and its reverse are
/// one. None where there are no strands. They are found as sets of one way that no bond closes. A
/// bond that costs as much as two ends and one more rope is never made, so that the dearest ways
/// may not be among them. Where `ends` of the rope are known, in the strands' pixels, an end there
/// costs nothing, and one elsewhere as much as it would without them and kElsewhere more.
[[nodiscard]] std::vector<Traversal> search(const Strands& strands, const Prices& prices, int count,
                                            const std::vector<Eigen::Vector2f>& ends = {});

/// The same of one rope that is known to be a ring: ways that close, each with the bond that closes
/// it. None where no bonds close one.
[[nodiscard]] std::vector<Traversal> search_rings(const Strands& strands, const Prices& prices,
                                                  int count);

/// The strands by which ways are told apart, in an order that is the same for a way and its
/// reverse, and for a ring wherever it begins. Strands below kMinorWidths tell nothing.
[[nodiscard]] std::vector<int> key_of(const Traversal& way, const Strands& strands);

inline constexpr float kElsewhere = 6;  ///< what an end costs that lies far from all known ones

}  // namespace flowdlo::path
