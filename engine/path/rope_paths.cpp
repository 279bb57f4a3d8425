#include "path/rope_paths.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "flowdlo/config.hpp"
#include "path/assemble.hpp"
#include "path/bonds.hpp"
#include "path/rope_sets.hpp"
#include "path/walk_costs.hpp"

namespace flowdlo::path {
namespace {

constexpr std::size_t kSets = 24;

// The strands that tell ways apart, the same for a way and its reverse.
std::vector<int> key_of(const Traversal& way, const Strands& strands) {
  std::vector<int> forwards;
  std::vector<int> backwards;
  for (const int end : way.enters) {
    const bool minor = strands.list[end / 2].covers_px < kMinorWidths * strands.scale_px;
    if (!minor) forwards.push_back(end);
  }
  for (auto it = forwards.rbegin(); it != forwards.rend(); ++it) backwards.push_back(*it ^ 1);
  if (way.closed && !forwards.empty()) {  // a ring begins anywhere
    std::rotate(forwards.begin(), std::min_element(forwards.begin(), forwards.end()),
                forwards.end());
    std::rotate(backwards.begin(), std::min_element(backwards.begin(), backwards.end()),
                backwards.end());
  }
  return std::min(forwards, backwards);
}

// By how much the cheapest set that has no such way costs more than the first.
float lead_of(const Traversal& way, const std::vector<RopeSet>& sets, const Strands& strands) {
  const auto key = key_of(way, strands);
  for (const RopeSet& set : sets) {
    const bool has = std::any_of(set.ways.begin(), set.ways.end(), [&](const Traversal& other) {
      return other.closed == way.closed && key_of(other, strands) == key;
    });
    if (!has) return std::min(kMostLead, set.cost - sets.front().cost);
  }
  return kMostLead;
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

Result<RopePaths> rope_paths(const Strands& given, const Region& region, const Frame& frame,
                             int ropes) {
  Strands strands = given;
  // Many tips tell of folds where they are one rope's; of several each has two.
  if (ropes != 1) {
    for (Strand& strand : strands.list) strand.folding = false;
  }
  const auto sets = search_sets(strands, make_bonds(strands, region, frame), ropes, kSets);
  if (sets.empty()) return no_set(ropes, strands);
  RopePaths result;
  result.rope_width_px = strands.width_px;
  for (const Traversal& way : sets.front().ways) {
    Path path = assemble(way, strands, region, frame);
    if (path.points_px.size() < 2) continue;
    path.width_px = strands.width_px;
    path.score = -static_cast<double>(sets.front().cost);
    result.ropes.push_back(std::move(path));
    result.lead.push_back(lead_of(way, sets, strands));
  }
  if (result.ropes.empty()) return no_set(ropes, strands);
  if (result.ropes.size() <= kMostRopes) return result;
  return Error{ErrorCode::kNoPath,
               fmt::format("path: expected at most {} ropes, got {} of a texture or of many "
                           "things; check the segmentation",
                           kMostRopes, result.ropes.size())};
}

}  // namespace flowdlo::path
