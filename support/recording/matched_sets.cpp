#include "recording/matched_sets.hpp"

#include <algorithm>
#include <cstdlib>
#include <numeric>

#include "recording/stamp_match.hpp"

namespace flowdlo::recording {
namespace {

constexpr double kNanosecondsAMillisecond = 1e6;
constexpr double kNanosecondsASecond = 1e9;

}  // namespace

std::vector<MatchedSet> matched(const Tracks& tracks, Stamp tolerance_ns) {
  const auto& depth = tracks.depth.stamps;
  const auto color = match_stamps(depth, tracks.color.stamps, tolerance_ns);
  const auto mask = match_stamps(depth, tracks.mask.stamps, tolerance_ns);
  std::vector<std::size_t> order(depth.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return depth[a] < depth[b]; });
  std::vector<MatchedSet> sets;
  for (const std::size_t i : order) {
    const bool has_color = tracks.color.topic.empty() || color[i].has_value();
    const bool has_mask = tracks.mask.topic.empty() || mask[i].has_value();
    if (!has_color || !has_mask) continue;
    sets.push_back({sets.size(), i, color[i].value_or(0), mask[i].value_or(0),
                    latest_until(tracks.camera.stamps, depth[i])});
  }
  return sets;
}

std::vector<MatchedSet> selected(const std::vector<MatchedSet>& sets, const Tracks& tracks,
                                 const RecordingOptions& options) {
  const auto& depth = tracks.depth.stamps;
  const Stamp first = *std::min_element(depth.begin(), depth.end());
  std::vector<MatchedSet> within;
  for (const MatchedSet& set : sets) {
    const double at_s = static_cast<double>(depth[set.depth] - first) / kNanosecondsASecond;
    if (at_s >= options.from_s && at_s <= options.to_s) within.push_back(set);
  }
  std::vector<MatchedSet> result;
  for (std::size_t i = 0; i < within.size(); i += static_cast<std::size_t>(options.every)) {
    result.push_back(within[i]);
  }
  return result;
}

double largest_gap_ms(const std::vector<MatchedSet>& sets, const Tracks& tracks) {
  Stamp largest = 0;
  for (const MatchedSet& set : sets) {
    const Stamp at = tracks.depth.stamps[set.depth];
    if (!tracks.color.topic.empty()) {
      largest = std::max(largest, std::abs(tracks.color.stamps[set.color] - at));
    }
    if (!tracks.mask.topic.empty()) {
      largest = std::max(largest, std::abs(tracks.mask.stamps[set.mask] - at));
    }
  }
  return static_cast<double>(largest) / kNanosecondsAMillisecond;
}

}  // namespace flowdlo::recording
