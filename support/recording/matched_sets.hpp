// MatchedSets: which messages of a recording make one frame.
#pragma once

#include <cstddef>
#include <vector>

#include "recording/recording_options.hpp"
#include "recording/tracks.hpp"

namespace flowdlo::recording {

/// Indices of the messages that make one frame.
struct MatchedSet {
  std::size_t number = 0;  ///< among all that were matched
  std::size_t depth = 0;
  std::size_t color = 0;
  std::size_t mask = 0;
  std::size_t camera = 0;
};

/// Every depth image with its partners, in the order of their stamps.
[[nodiscard]] std::vector<MatchedSet> matched(const Tracks& tracks, Stamp tolerance_ns);

/// Those from-to, and every Nth of them.
[[nodiscard]] std::vector<MatchedSet> selected(const std::vector<MatchedSet>& sets,
                                               const Tracks& tracks,
                                               const RecordingOptions& options);

/// Milliseconds from a depth image to its partners, at most.
[[nodiscard]] double largest_gap_ms(const std::vector<MatchedSet>& sets, const Tracks& tracks);

}  // namespace flowdlo::recording
