// SecondOpinion: where another reading of the same frame goes on beyond the end of a strand.
#pragma once

#include <map>
#include <utility>
#include <vector>

#include "path/path.hpp"
#include "path/region.hpp"
#include "path/strands.hpp"

namespace flowdlo::path {

/// What another reading says of the ends of strands; shares are in [0, 1], of likelihood. Without
/// any it says nothing.
struct Opinion {
  std::vector<float> known{};    ///< [2 * strands] the strand is there
  std::vector<float> goes_on{};  ///< [2 * strands] the rope goes on to an end of another strand
  std::map<std::pair<int, int>, float> joined{};  ///< these two ends, the lower first, are joined

  /// How likely it is that one of the two ends does not go on to the other one.
  [[nodiscard]] float against(int a, int b) const;
  /// How likely the rope goes on from that end to another strand.
  [[nodiscard]] float going_on(int end) const { return goes_on.empty() ? 0 : goes_on[end]; }
};

/// By another reading's `guesses`, whose places are those of the frame that `region` was cut out
/// of.
[[nodiscard]] Opinion opinion_on(const Strands& strands, const std::vector<RopesGuess>& guesses,
                                 const Region& region);

}  // namespace flowdlo::path
