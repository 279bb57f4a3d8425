#include "path/rope_paths.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

#include "flowdlo/config.hpp"
#include "path/assemble.hpp"
#include "path/search.hpp"

namespace flowdlo::path {
namespace {

constexpr std::size_t kSets = 24;
// Who says how many ropes there are is right rather than wrong, as the logarithm of the odds.
constexpr float kNumberKnown = 3;
constexpr float kLeastShare = 0.02F;  // of a set that is worth telling of, beside the first

// By how much the cheapest of the sets that has no such way costs more than `cost`, at most
// kMostLead either way.
float lead_of(const Traversal& way, const std::vector<RopeSet>& sets, float cost,
              const Strands& strands) {
  const auto key = key_of(way, strands);
  for (const RopeSet& set : sets) {
    const bool has = std::any_of(set.ways.begin(), set.ways.end(), [&](const Traversal& other) {
      return other.closed == way.closed && key_of(other, strands) == key;
    });
    if (!has) return std::clamp(set.cost - cost, -kMostLead, kMostLead);
  }
  return kMostLead;
}

// Of a closed way's links the one that most likely joins a rope's two own ends.
float ends_met(const Traversal& way, const Strands& strands) {
  float most = 0;
  for (std::size_t i = 0; way.closed && i < way.enters.size(); ++i) {
    const StrandEnd& from = strands.end(way.enters[i] ^ 1);
    const StrandEnd& to = strands.end(way.enters[(i + 1) % way.enters.size()]);
    most = std::max(most, std::min(from.tip_seen, to.tip_seen));
  }
  return most;
}

// Ways as paths, each drawn once.
class Drawing {
 public:
  Drawing(const Strands& strands, const Region& region, const Frame& frame)
      : strands_(strands), region_(region), frame_(frame) {}

  // Of fewer than two points where there is nothing to draw.
  const Path& of(const Traversal& way) {
    const auto [place, added] = drawn_.try_emplace(std::pair(way.enters, way.closed));
    if (added) {
      place->second = assemble(way, strands_, region_, frame_);
      place->second.width_px = strands_.width_px;
      place->second.ends_met = ends_met(way, strands_);
    }
    return place->second;
  }

  std::vector<Path> of(const RopeSet& set) {
    std::vector<Path> paths;
    for (const Traversal& way : set.ways) {
      if (of(way).points_px.size() >= 2) paths.push_back(of(way));
    }
    return paths;
  }

 private:
  const Strands& strands_;
  const Region& region_;
  const Frame& frame_;
  std::map<std::pair<std::vector<int>, bool>, Path> drawn_;
};

// The likeliest of sets that come cheapest first: costs are negative logarithms.
std::vector<RopesGuess> guesses_of(const std::vector<RopeSet>& sets, Drawing& drawing) {
  std::vector<RopesGuess> guesses;
  float sum = 0;
  for (const RopeSet& set : sets) {
    const float share = std::exp(sets.front().cost - set.cost);
    if (share < kLeastShare) break;
    guesses.push_back({drawing.of(set), share});
    sum += share;
  }
  for (RopesGuess& guess : guesses) guess.share /= sum;
  return guesses;
}

Error no_set(int ropes, const Strands& strands) {
  if (ropes == 0) {
    return {ErrorCode::kNoPath,
            "path: expected strokes longer than they are wide, got spots; check the segmentation"};
  }
  return {ErrorCode::kNoPath,
          fmt::format("path: expected a mask of {} ropes, got {} stretches between crossings and "
                      "ends that are not so many; check the number or the segmentation",
                      ropes, strands.list.size())};
}

}  // namespace

Result<RopePaths> rope_paths(const Strands& strands, const Prices& prices, const Region& region,
                             const Frame& frame, int ropes) {
  const auto sets = search_sets(strands, prices, ropes, kSets);
  if (sets.empty()) return no_set(ropes, strands);
  // A number that the strands speak against more than its giver is to be trusted.
  const auto of_any_number =
      ropes > 0 ? search_sets(strands, prices, 0, kSets) : std::vector<RopeSet>();
  RopePaths result;
  result.rope_width_px = strands.width_px;
  result.filtered = region.filtered;
  Drawing drawing(strands, region, frame);
  for (const Traversal& way : sets.front().ways) {
    Path path = drawing.of(way);
    if (path.points_px.size() < 2) continue;
    path.score = -static_cast<double>(sets.front().cost);
    result.ropes.push_back(std::move(path));
    const float cost = sets.front().cost;
    result.lead.push_back(std::min(lead_of(way, sets, cost, strands),
                                   lead_of(way, of_any_number, cost, strands) + kNumberKnown));
  }
  if (result.ropes.empty()) return no_set(ropes, strands);
  result.guesses = guesses_of(sets, drawing);
  if (result.ropes.size() <= kMostRopes) return result;
  return Error{ErrorCode::kNoPath,
               fmt::format("path: expected at most {} ropes, got {} of a texture or of many "
                           "things; check the segmentation",
                           kMostRopes, result.ropes.size())};
}

}  // namespace flowdlo::path
