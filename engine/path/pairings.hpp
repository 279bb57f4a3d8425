// Pairings: the cheapest ways to pair things up, some of them left alone.
#pragma once

#include <cstddef>
#include <vector>

namespace flowdlo::path {

/// Two different items that may go together.
struct Pair {
  int a = 0;
  int b = 0;
  float cost = 0;  ///< at least 0
};

/// Every item is in one of the pairs or alone.
struct Pairing {
  std::vector<int> pair_of;  ///< [items] index of the pair that each is in; -1: alone
  float cost = 0;            ///< of the pairs and of those alone
};

/// At most `count` different pairings, cheapest first; `alone` is [items], what each costs alone,
/// at least 0. A pair that costs as much as both of its items alone is never made. Items fall into
/// groups that no pair joins, each of which is solved on its own: best first with a bound from the
/// dual of the linear programme, exact unless the group is so tangled that the work would not be
/// bounded; a beam search answers there. Deterministic.
/// Items 2 * i and 2 * i + 1 are two ends of one thing: pairs make chains of things. Without
/// `closed` no chain of several things may come back to its beginning.
[[nodiscard]] std::vector<Pairing> cheapest_pairings(const std::vector<float>& alone,
                                                     const std::vector<Pair>& pairs,
                                                     std::size_t count, bool closed = true);

}  // namespace flowdlo::path
