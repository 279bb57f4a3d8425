#include "path/search.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "path/overlaps.hpp"
#include "path/pairings.hpp"
#include "path/touches.hpp"

namespace flowdlo::path {
namespace {

constexpr std::size_t kPairings = 48;  // of one price
constexpr float kTightWidths = 8;      // a ring is this long: bends of three radii, seen aslant
constexpr float kTightCost = 10;       // of a shorter one
constexpr int kPriceSteps = 10;        // each twice as far, until a price is too high or too low,
constexpr int kPriceHalvings = 6;      // and then between two that are
constexpr float kNoEnds = 1000;        // of a rope, a price at which none has two ends
constexpr float kEndReach = 2;         // widths within which a place means an end
constexpr float kStumpWidths = 3;      // a way that is no longer is never seen twice

// The ends of all strands as things to be paired: by a bond, or, where a strand is left out, its
// two with each other.
class Ends {
 public:
  // `stops` [2 * strands]: what it costs a way to end at each. Without `closed` only strands that
  // are rings themselves close. With `overlaps` a set has no rope twice.
  Ends(const Strands& strands, const std::vector<std::vector<Bond>>& bonds,
       std::vector<float> stops, bool closed, const Overlaps* overlaps = nullptr)
      : strands_(strands), overlaps_(overlaps), stops_(std::move(stops)), closed_(closed) {
    for (int from = 0; from < static_cast<int>(bonds.size()); ++from) {
      for (const Bond& bond : bonds[from]) {
        const auto key = std::minmax(from, bond.to);
        if (key.first == key.second) continue;
        if (key.first / 2 == key.second / 2 && (!closed || tight({{key.first}, 0, true}))) continue;
        const float cost = std::max(0.0F, bond.cost);
        const auto [place, added] = bonds_.try_emplace(key, cost);
        if (!added) place->second = std::min(place->second, cost);
      }
    }
    for (const auto& [ends, cost] : bonds_) pairs_.push_back({ends.first, ends.second, cost});
    for (int s = 0; s < static_cast<int>(strands.list.size()); ++s) {
      if (strands.list[s].ring) pairs_.push_back({2 * s, 2 * s + 1, 0});
    }
    first_left_out_ = static_cast<int>(pairs_.size());
    for (int s = 0; s < static_cast<int>(strands.list.size()); ++s) {
      pairs_.push_back({2 * s, 2 * s + 1, left_out_energy(strands.list[s], strands)});
      all_left_out_ += pairs_.back().cost;
    }
  }

  // The sets that the cheapest pairings are when one more rope costs `price`; `cost` without it.
  [[nodiscard]] std::vector<RopeSet> sets(float price, std::size_t count) const {
    std::vector<float> alone;
    for (const float stop : stops_) alone.push_back(std::max(0.0F, stop + 0.5F * price));
    std::vector<RopeSet> result;
    for (const Pairing& pairing : cheapest_pairings(alone, pairs_, count, closed_)) {
      RopeSet set{ways(pairing), pairing.cost};
      const auto open = std::count_if(set.ways.begin(), set.ways.end(),
                                      [](const Traversal& way) { return !way.closed; });
      set.cost -= price * static_cast<float>(open);
      for (const Traversal& way : set.ways) set.cost += tight(way) ? kTightCost : 0;
      if (overlaps_ != nullptr) drop_what_is_seen_twice(set);
      if (!set.ways.empty()) result.push_back(std::move(set));
    }
    return result;
  }

  // The sets at prices around which so many ropes are the cheapest number; of other numbers, too.
  [[nodiscard]] std::vector<RopeSet> sets_around(std::size_t ropes) const {
    float price = 0;
    std::optional<float> low;   // the highest price known to leave too many,
    std::optional<float> high;  // and the lowest that leaves too few
    float change = 1;
    for (int step = 0, halvings = 0; step <= kPriceSteps && halvings <= kPriceHalvings;) {
      const auto cheapest = sets(price, 1);
      const std::size_t found = cheapest.empty() ? 0 : cheapest.front().ways.size();
      if (found == ropes) return sets(price, kPairings);
      (found > ropes ? low : high) = price;
      if (low && high) {
        price = 0.5F * (*low + *high);
        ++halvings;
      } else {
        price = found > ropes ? change : -change;
        change *= 2;
        ++step;
      }
    }
    std::vector<RopeSet> result;
    for (const auto& end : {low, high}) {
      if (!end) continue;
      for (RopeSet& set : sets(*end, kPairings)) result.push_back(std::move(set));
    }
    return result;
  }

  // The way as the only rope's, all other strands left out.
  [[nodiscard]] Traversal alone(Traversal way) const {
    way.cost = all_left_out_;
    for (const int enter : way.enters) way.cost -= pairs_[first_left_out_ + enter / 2].cost;
    way.cost += own_cost(way);
    return way;
  }

 private:
  // What a way pays for its bonds and for where it ends.
  [[nodiscard]] float own_cost(const Traversal& way) const {
    float cost = 0;
    if (strands_.list[way.enters.front() / 2].ring) return cost;
    for (std::size_t i = 1; i < way.enters.size(); ++i) {
      cost += bond_cost(way.enters[i - 1] ^ 1, way.enters[i]);
    }
    if (way.closed) {
      cost += bond_cost(way.enters.back() ^ 1, way.enters.front());
      return cost + (tight(way) ? kTightCost : 0);
    }
    return cost + stops_[way.enters.front()] + stops_[way.enters.back() ^ 1];
  }

  [[nodiscard]] float covers_px(const Traversal& way) const {
    float sum = 0;
    for (const int enter : way.enters) sum += strands_.list[enter / 2].covers_px;
    return sum;
  }

  // Takes ways out of a set, the shortest first, where the others lie on so much of them that
  // leaving out the rest costs less than the way does. Closed ways stay: turns of a coil lie beside
  // each other.
  void drop_what_is_seen_twice(RopeSet& set) const {
    std::vector<std::uint8_t> used(strands_.list.size(), 0);
    const auto use = [&](const Traversal& way, bool is) {
      for (const int enter : way.enters) used[enter / 2] = is ? 1 : 0;
    };
    std::vector<std::pair<float, std::size_t>> shortest;
    for (std::size_t i = 0; i < set.ways.size(); ++i) {
      shortest.emplace_back(covers_px(set.ways[i]), i);
      use(set.ways[i], true);
    }
    std::sort(shortest.begin(), shortest.end());
    std::vector<std::uint8_t> dropped(set.ways.size(), 0);
    for (const auto& [length_px, i] : shortest) {
      const Traversal& way = set.ways[i];
      const float width_px = width_px_of(strands_.list[way.enters.front() / 2], strands_);
      if (way.closed || length_px <= kStumpWidths * width_px) continue;
      use(way, false);
      float more = -own_cost(way);
      for (const int enter : way.enters) {
        more += pairs_[first_left_out_ + enter / 2].cost * overlaps_->bare_share(enter / 2, used);
      }
      dropped[i] = more < 0 ? 1 : 0;
      if (more < 0) {
        set.cost += more;
      } else {
        use(way, true);
      }
    }
    std::vector<Traversal> kept;
    for (std::size_t i = 0; i < set.ways.size(); ++i) {
      if (dropped[i] == 0) kept.push_back(std::move(set.ways[i]));
    }
    set.ways = std::move(kept);
  }

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

  [[nodiscard]] float bond_cost(int from, int to) const { return bonds_.at(std::minmax(from, to)); }

  [[nodiscard]] bool left_out(const Pairing& pairing, int strand) const {
    return pairing.pair_of[2 * strand] >= first_left_out_;
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
  const Overlaps* overlaps_;  // or null
  std::vector<float> stops_;
  bool closed_;
  std::map<std::pair<int, int>, float> bonds_;  // the cheapest of two ends
  std::vector<Pair> pairs_;
  int first_left_out_ = 0;  // of the pairs: from here on one for each strand that is left out
  float all_left_out_ = 0;  // what it costs to use no strand
};

// [2 * strands] what it costs the only rope to end at each; some of its ends may be known.
std::vector<float> only_stops_of(const Strands& strands, std::vector<float> stops,
                                 const std::vector<Eigen::Vector2f>& known) {
  for (int end = 0; end < static_cast<int>(stops.size()); ++end) {
    const float cost = stops[end] + (strands.end(end).leaves ? kLeavesEnergy : 0);
    float near = 0;
    for (const Eigen::Vector2f& place : known) {
      const float off = (strands.end(end).point_px - place).norm() / strands.scale_px;
      near = std::max(near, std::exp(-0.5F * off * off / (kEndReach * kEndReach)));
    }
    stops[end] = known.empty() ? cost : (1 - near) * (cost + kElsewhere);
  }
  return stops;
}

std::ptrdiff_t closed_by_bonds(const RopeSet& set, const Strands& strands) {
  return std::count_if(set.ways.begin(), set.ways.end(), [&](const Traversal& way) {
    return way.closed && !strands.list[way.enters.front() / 2].ring;
  });
}

template <class Priced>
void sort_and_cut(std::vector<Priced>& list, std::size_t count) {
  std::stable_sort(list.begin(), list.end(),
                   [](const Priced& a, const Priced& b) { return a.cost < b.cost; });
  if (list.size() > count) list.resize(count);
}

// At most `count` sets, cheapest first: of those of the same ways, which differ in what was seen
// twice, the cheapest.
std::vector<RopeSet> each_once(std::vector<RopeSet> sets, std::size_t count) {
  sort_and_cut(sets, sets.size());
  std::set<std::vector<std::vector<int>>> known;
  std::vector<RopeSet> result;
  for (RopeSet& set : sets) {
    std::vector<std::vector<int>> ways;
    for (const Traversal& way : set.ways) ways.push_back(way.enters);
    if (result.size() < count && known.insert(std::move(ways)).second) {
      result.push_back(std::move(set));
    }
  }
  return result;
}

// The ways of the sets, each as the only rope's, cheapest first; of those of one kind the cheapest.
std::vector<Traversal> ways_alone(const Ends& ends, const std::vector<RopeSet>& sets,
                                  const Strands& strands, int count) {
  std::map<std::vector<int>, Traversal> found;
  for (const RopeSet& set : sets) {
    for (const Traversal& way : set.ways) {
      Traversal one = ends.alone(way);
      auto key = key_of(one, strands);
      if (key.empty()) key = one.enters;
      const auto [place, added] = found.try_emplace(std::move(key), one);
      if (!added && one.cost < place->second.cost) place->second = std::move(one);
    }
  }
  std::vector<Traversal> result;
  for (auto& [key, way] : found) result.push_back(std::move(way));
  sort_and_cut(result, static_cast<std::size_t>(count));
  return result;
}

}  // namespace

std::vector<int> key_of(const Traversal& way, const Strands& strands) {
  std::vector<int> forwards;
  std::vector<int> backwards;
  for (const int end : way.enters) {
    const bool minor = strands.list[end / 2].covers_px < kMinorWidths * strands.scale_px;
    if (!minor) forwards.push_back(end);
  }
  for (auto it = forwards.rbegin(); it != forwards.rend(); ++it) backwards.push_back(*it ^ 1);
  if (way.closed && !forwards.empty()) {
    std::rotate(forwards.begin(), std::min_element(forwards.begin(), forwards.end()),
                forwards.end());
    std::rotate(backwards.begin(), std::min_element(backwards.begin(), backwards.end()),
                backwards.end());
  }
  return std::min(forwards, backwards);
}

std::vector<RopeSet> search_sets(const Strands& strands, const Prices& prices, int ropes,
                                 std::size_t count) {
  const Overlaps overlaps(strands);
  const Ends ends(strands, prices.bonds, prices.stops, true, &overlaps);
  const auto wanted = static_cast<std::size_t>(ropes);
  std::vector<RopeSet> found;
  for (RopeSet& set : ropes > 0 ? ends.sets_around(wanted) : ends.sets(0, kPairings)) {
    if (ropes > 0 && set.ways.size() != wanted) continue;
    set.cost += kTouchEnergy * static_cast<float>(touches(set, strands)) +
                kRingEnergy * static_cast<float>(closed_by_bonds(set, strands));
    found.push_back(std::move(set));
  }
  return each_once(std::move(found), count);
}

std::vector<Traversal> search(const Strands& strands, const Prices& prices, int count,
                              const std::vector<Eigen::Vector2f>& ends) {
  const Ends paired(strands, prices.bonds, only_stops_of(strands, prices.stops, ends), false);
  return ways_alone(paired, paired.sets_around(1), strands, count);
}

std::vector<Traversal> search_rings(const Strands& strands, const Prices& prices, int count) {
  const Ends paired(strands, prices.bonds, prices.stops, true);
  std::vector<RopeSet> sets = paired.sets(kNoEnds, kPairings);
  for (RopeSet& set : sets) {
    const auto open = [](const Traversal& way) { return !way.closed; };
    set.ways.erase(std::remove_if(set.ways.begin(), set.ways.end(), open), set.ways.end());
  }
  return ways_alone(paired, sets, strands, count);
}

}  // namespace flowdlo::path
