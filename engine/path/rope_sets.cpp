#include "path/rope_sets.hpp"

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>

#include "path/pairings.hpp"

namespace flowdlo::path {
namespace {

constexpr std::size_t kPairings = 48;  // of one price
constexpr float kTightWidths = 8;      // a ring is this long: bends of three radii, seen aslant
constexpr float kTightCost = 10;       // of a shorter one
constexpr int kPriceSteps = 6;         // each twice as far, at which a wanted number is looked for

// The ends of all strands as things to be paired: by a bond, or, where a strand is left out, its
// two with each other.
class Ends {
 public:
  Ends(const Strands& strands, const std::vector<std::vector<Bond>>& bonds) : strands_(strands) {
    std::map<std::pair<int, int>, float> cheapest;  // of two ends
    for (int from = 0; from < static_cast<int>(bonds.size()); ++from) {
      for (const Bond& bond : bonds[from]) {
        const auto key = std::minmax(from, bond.to);
        if (key.first == key.second) continue;
        if (key.first / 2 == key.second / 2 && tight({{key.first}, 0, true})) continue;
        const float cost = std::max(0.0F, bond.cost);
        const auto [place, added] = cheapest.try_emplace(key, cost);
        if (!added) place->second = std::min(place->second, cost);
      }
    }
    for (const auto& [ends, cost] : cheapest) pairs_.push_back({ends.first, ends.second, cost});
    for (int s = 0; s < static_cast<int>(strands.list.size()); ++s) {
      const Strand& strand = strands.list[s];
      if (strand.ring) pairs_.push_back({2 * s, 2 * s + 1, 0});
    }
    bonds_ = static_cast<int>(pairs_.size());
    for (int s = 0; s < static_cast<int>(strands.list.size()); ++s) {
      pairs_.push_back({2 * s, 2 * s + 1, left_out_energy(strands.list[s], strands)});
    }
  }

  // The sets that the cheapest pairings are when one more rope costs `price`; `cost` without it.
  [[nodiscard]] std::vector<RopeSet> sets(float price) const {
    std::vector<float> alone;
    for (int end = 0; end < 2 * static_cast<int>(strands_.list.size()); ++end) {
      alone.push_back(std::max(0.0F, strands_.end(end).end_cost + 0.5F * price));
    }
    std::vector<RopeSet> result;
    for (const Pairing& pairing : cheapest_pairings(alone, pairs_, kPairings)) {
      RopeSet set{ways(pairing), pairing.cost};
      const auto open = std::count_if(set.ways.begin(), set.ways.end(),
                                      [](const Traversal& way) { return !way.closed; });
      set.cost -= price * static_cast<float>(open);
      for (const Traversal& way : set.ways) set.cost += tight(way) ? kTightCost : 0;
      if (!set.ways.empty()) result.push_back(std::move(set));
    }
    return result;
  }

 private:
  // Whether a rope would have to bend more tightly than ropes do to close like that.
  [[nodiscard]] bool tight(const Traversal& way) const {
    if (!way.closed) return false;
    float length_px = 0;
    for (std::size_t i = 0; i < way.enters.size(); ++i) {
      const int enter = way.enters[i];
      const int next = way.enters[(i + 1) % way.enters.size()];
      length_px += strands_.list[enter / 2].covers_px;
      length_px += (strands_.end(next).point_px - strands_.end(enter ^ 1).point_px).norm();
    }
    const Strand& first = strands_.list[way.enters.front() / 2];
    return length_px < kTightWidths * width_px_of(first, strands_);
  }

  [[nodiscard]] bool left_out(const Pairing& pairing, int strand) const {
    return pairing.pair_of[2 * strand] >= bonds_;
  }

  // The way that enters its first strand by `enter`, as far as it goes.
  [[nodiscard]] Traversal way_from(int enter, const Pairing& pairing,
                                   std::vector<std::uint8_t>& used) const {
    Traversal way;
    for (int at = enter;;) {
      way.enters.push_back(at);
      used[at / 2] = 1;
      const int pair = pairing.pair_of[at ^ 1];
      if (pair < 0) return way;
      at = pairs_[pair].a == (at ^ 1) ? pairs_[pair].b : pairs_[pair].a;
      if (at != enter) continue;
      way.closed = true;
      return way;
    }
  }

  [[nodiscard]] std::vector<Traversal> ways(const Pairing& pairing) const {
    std::vector<Traversal> result;
    const int count = static_cast<int>(strands_.list.size());
    std::vector<std::uint8_t> used(strands_.list.size(), 0);
    for (int s = 0; s < count; ++s) used[s] = left_out(pairing, s) ? 1 : 0;
    for (int end = 0; end < 2 * count; ++end) {
      if (used[end / 2] == 0 && pairing.pair_of[end] < 0) {
        result.push_back(way_from(end, pairing, used));
      }
    }
    for (int s = 0; s < count; ++s) {
      if (used[s] == 0) result.push_back(way_from(2 * s, pairing, used));
    }
    return result;
  }

  const Strands& strands_;
  std::vector<Pair> pairs_;
  int bonds_ = 0;  // so many of the pairs; the others leave a strand out
};

bool cheaper(const RopeSet& a, const RopeSet& b) { return a.cost < b.cost; }

}  // namespace

std::vector<RopeSet> search_sets(const Strands& strands,
                                 const std::vector<std::vector<Bond>>& bonds, int ropes,
                                 std::size_t count) {
  const Ends ends(strands, bonds);
  const auto wanted = static_cast<std::size_t>(ropes);
  std::vector<RopeSet> found;
  float price = 0;
  float change = 0.5F;
  for (int step = 0; step <= kPriceSteps && found.empty(); ++step) {
    std::vector<RopeSet> sets = ends.sets(price);
    if (sets.empty()) return {};
    const bool too_many = sets.front().ways.size() > wanted;
    for (RopeSet& set : sets) {
      if (ropes > 0 && set.ways.size() != wanted) continue;
      for (const Traversal& way : set.ways) set.cost += way.closed ? kRingEnergy : 0;
      found.push_back(std::move(set));
    }
    change *= 2;
    price = too_many ? change : -change;
  }
  std::stable_sort(found.begin(), found.end(), cheaper);
  if (found.size() > count) found.resize(count);
  return found;
}

}  // namespace flowdlo::path
