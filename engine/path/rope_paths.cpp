#include "path/rope_paths.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "flowdlo/config.hpp"
#include "geometry/polyline.hpp"
#include "path/assemble.hpp"
#include "path/search.hpp"

namespace flowdlo::path {
namespace {

using Eigen::Vector2f;
using Points = std::vector<Vector2f>;

constexpr std::size_t kSets = 24;
// Who says how many ropes there are is right rather than wrong, as the logarithm of the odds.
constexpr float kNumberKnown = 3;
// Of each rope of a set that the frame before has not, and of each of its ropes that the set has
// not: two ropes that exchange what lies beyond a crossing cost 8, as much as a way of one rope
// does that is not the one before (Hints::previous).
constexpr float kChanged = 2;
constexpr int kCompared = 64;         // points of a path that are held against another one's
constexpr float kSameWidths = 1.5F;   // between two paths of one rope, at most
constexpr float kLeastShare = 0.02F;  // of a set that is worth telling of, beside the first

float apart_px(const Points& a, const Points& b) {
  float most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, (a[i] - b[i]).norm());
  return most;
}

// How far a point of one path is from all of another one, at most.
float strays_px(const Points& from, const Points& to) {
  float most = 0;
  for (const Vector2f& p : from) {
    float least = std::numeric_limits<float>::max();
    for (const Vector2f& q : to) least = std::min(least, (p - q).squaredNorm());
    most = std::max(most, least);
  }
  return std::sqrt(most);
}

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

// The ropes of the frame before, as evidence; each way is held against them once.
class Before {
 public:
  Before(const std::vector<Path>& ropes, float width_px, Drawing& drawing)
      : ropes_(ropes), width_px_(width_px), drawing_(drawing) {}

  // Of sets that come cheapest first the one that is cheapest beside this.
  const RopeSet& cheapest(const std::vector<RopeSet>& sets) {
    if (ropes_.empty()) return sets.front();
    const RopeSet* best = &sets.front();
    float least = std::numeric_limits<float>::max();
    for (const RopeSet& set : sets) {
      if (set.cost >= least) break;
      const float cost = set.cost + changed(set);
      if (cost >= least) continue;
      least = cost;
      best = &set;
    }
    return *best;
  }

 private:
  // What a set costs more for what is not as it was.
  float changed(const RopeSet& set) {
    std::vector<bool> stayed(ropes_.size(), false);
    float cost = 0;
    for (const Traversal& way : set.ways) {
      const std::vector<bool>& same = same_as(drawing_.of(way));
      std::size_t k = 0;
      while (k < same.size() && (stayed[k] || !same[k])) ++k;
      if (k < same.size()) {
        stayed[k] = true;
      } else {
        cost += kChanged;
      }
    }
    return cost + kChanged * static_cast<float>(std::count(stayed.begin(), stayed.end(), false));
  }

  // [ropes] whether a drawn path is that one.
  const std::vector<bool>& same_as(const Path& path) {
    const auto [place, added] = same_.try_emplace(&path);
    if (added) {
      for (const Path& rope : ropes_) place->second.push_back(same_rope(path, rope, width_px_));
    }
    return place->second;
  }

  const std::vector<Path>& ropes_;
  float width_px_;
  Drawing& drawing_;
  std::map<const Path*, std::vector<bool>> same_;
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

bool same_rope(const Path& a, const Path& b, float width_px) {
  if (a.closed != b.closed || a.points_px.size() < 2 || b.points_px.size() < 2) return false;
  const float most = kSameWidths * width_px;
  if (a.closed) {  // a ring begins anywhere
    return strays_px(a.points_px, b.points_px) <= most &&
           strays_px(b.points_px, a.points_px) <= most;
  }
  const Points one = geometry::resample(a.points_px, kCompared);
  Points two = geometry::resample(b.points_px, kCompared);
  if (apart_px(one, two) <= most) return true;
  std::reverse(two.begin(), two.end());
  return apart_px(one, two) <= most;
}

Result<RopePaths> rope_paths(const Strands& strands, const Prices& prices, const Region& region,
                             const Frame& frame, const Beside& beside) {
  const auto sets = search_sets(strands, prices, beside.number, kSets);
  if (sets.empty()) return no_set(beside.number, strands);
  // A number that the strands speak against more than its giver is to be trusted.
  const auto of_any_number =
      beside.number > 0 ? search_sets(strands, prices, 0, kSets) : std::vector<RopeSet>();
  RopePaths result;
  result.rope_width_px = strands.width_px;
  result.filtered = region.filtered;
  Drawing drawing(strands, region, frame);
  const RopeSet& set = Before(beside.before, strands.width_px, drawing).cheapest(sets);
  for (const Traversal& way : set.ways) {
    Path path = drawing.of(way);
    if (path.points_px.size() < 2) continue;
    path.score = -static_cast<double>(set.cost);
    result.ropes.push_back(std::move(path));
    result.lead.push_back(std::min(lead_of(way, sets, set.cost, strands),
                                   lead_of(way, of_any_number, set.cost, strands) + kNumberKnown));
  }
  if (result.ropes.empty()) return no_set(beside.number, strands);
  result.guesses = guesses_of(sets, drawing);
  if (result.ropes.size() <= kMostRopes) return result;
  return Error{ErrorCode::kNoPath,
               fmt::format("path: expected at most {} ropes, got {} of a texture or of many "
                           "things; check the segmentation",
                           kMostRopes, result.ropes.size())};
}

}  // namespace flowdlo::path
