#include "path/links.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "path/link_evidence.hpp"
#include "path/link_network.hpp"

namespace flowdlo::path {
namespace {

constexpr std::size_t kLinksAnEnd = 8;
constexpr std::size_t kMostEnds = 96;
constexpr float kKnownWidths = 3.0F;  // strands shorter than this are stumps
constexpr float kMostEnergy = 16.0F;  // or what leaving out a longer strand costs

struct Nearness {
  int from = 0;
  int to = 0;
  float least = 0;  // what a link between them costs at least,
  float most = 0;   // and at most
};

// The ends of the longest strands that are no rings.
std::vector<int> open_ends(const Strands& strands) {
  std::vector<int> ends;
  for (int id = 0; id < static_cast<int>(2 * strands.list.size()); ++id) {
    if (!strands.list[id / 2].ring) ends.push_back(id);
  }
  if (ends.size() <= kMostEnds) return ends;
  std::stable_sort(ends.begin(), ends.end(), [&](int a, int b) {
    return strands.list[a / 2].covers_px > strands.list[b / 2].covers_px;
  });
  ends.resize(kMostEnds);
  return ends;
}

const LinkTerms& weights_of(const Strands& strands) {
  return strands.several ? kSeveralRopesLinks : kOneRopeLinks;
}

LinkConfig config_between(int from, int to, const Strands& strands, const LinkTerms& weights,
                          float elsewhere) {
  const auto shorter = static_cast<float>(
      std::min(strands.list[from / 2].points_px.size(), strands.list[to / 2].points_px.size()));
  const float scale_px = scale_between(strands.end(from), strands.end(to), strands);
  return {weights, scale_px, std::min(1.0F, shorter / (kKnownWidths * scale_px)), elsewhere};
}

// No link costs more than leaving out what lies beyond it.
float most_for(int a, int b, const Strands& strands) {
  return std::max({kMostEnergy, left_out_energy(strands.list[a / 2], strands),
                   left_out_energy(strands.list[b / 2], strands)});
}

// Pairs of ends that a link may join; the short ones first: most others then cost more than what is
// kept.
std::vector<Nearness> near_pairs(const Strands& strands, bool ring) {
  const LinkTerms& weights = weights_of(strands);
  const std::vector<int> ends = open_ends(strands);
  std::vector<Nearness> pairs;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    for (std::size_t j = i + 1; j < ends.size(); ++j) {
      if (ends[i] / 2 == ends[j] / 2 && !strands.several && !ring) continue;
      const StrandEnd& a = strands.end(ends[i]);
      const StrandEnd& b = strands.end(ends[j]);
      const float apart = (a.point_px - b.point_px).norm();
      const float least = least_energy(apart, weights, scale_between(a, b, strands));
      if (strands.several && a.leaves && b.leaves) continue;
      const float most = most_for(ends[i], ends[j], strands);
      if (least >= most) continue;
      pairs.push_back({std::min(ends[i], ends[j]), std::max(ends[i], ends[j]), least, most});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Nearness& a, const Nearness& b) { return a.least < b.least; });
  return pairs;
}

bool cheaper(const Bond& a, const Bond& b) {
  return a.cost != b.cost ? a.cost < b.cost : a.to < b.to;
}

// The few links of each end that cost least.
class Offers {
 public:
  Offers(const Strands& strands, const Cover& cover, const Opinion& opinion, bool ring)
      : cheapest_(2 * strands.list.size()) {
    const LinkTerms& weights = weights_of(strands);
    for (const Nearness& pair : near_pairs(strands, ring)) {
      const float most = std::min(pair.most, std::max(kept(pair.from), kept(pair.to)));
      if (pair.least >= most) continue;
      const Link link = link_between(pair.from, pair.to, strands, cover, weights, most,
                                     opinion.against(pair.from, pair.to));
      if (link.energy >= most) continue;
      keep(pair.from, pair.to, link.energy);
      keep(pair.to, pair.from, link.energy);
      links_.try_emplace({pair.from, pair.to}, link);
    }
  }

  [[nodiscard]] const std::vector<std::vector<Bond>>& cheapest() const { return cheapest_; }
  // By both ends, the lower one first, from which it leads.
  [[nodiscard]] const std::map<std::pair<int, int>, Link>& links() const { return links_; }

 private:
  [[nodiscard]] float kept(int end) const {
    return cheapest_[end].size() < kLinksAnEnd ? std::numeric_limits<float>::max()
                                               : cheapest_[end].back().cost;
  }
  void keep(int end, int other, float energy) {
    auto& list = cheapest_[end];
    const Bond bond{other, energy};
    list.insert(std::upper_bound(list.begin(), list.end(), bond, cheaper), bond);
    if (list.size() > kLinksAnEnd) list.pop_back();
  }

  std::vector<std::vector<Bond>> cheapest_;
  std::map<std::pair<int, int>, Link> links_;
};

Prices by_energy(const Offers& offers, const Strands& strands, const Opinion& opinion) {
  Prices prices{offers.cheapest(), {}};
  for (int end = 0; end < static_cast<int>(prices.bonds.size()); ++end) {
    const StopTerms terms = stop_terms(strands.end(end), opinion.going_on(end));
    prices.stops.push_back(energy_of(terms, kStopWeights));
  }
  return prices;
}

Prices by_network(const Offers& offers, const Strands& strands, const Cover& cover,
                  const Opinion& opinion) {
  const LinkNetwork network(*strands.links);
  Prices prices{offers.cheapest(), {}};
  const auto count = static_cast<int>(prices.bonds.size());
  std::vector<EndFeatures> ends;
  for (int end = 0; end < count; ++end) {
    ends.push_back(end_features(end, strands, cover, opinion.going_on(end)));
    const float more = strands.several ? kOneMoreEnergy / 2 : 0;
    prices.stops.push_back(network.stop(ends.back()) + more);
  }
  std::map<std::pair<int, int>, float> costs;  // of the links that are kept, by both ends
  for (int end = 0; end < count; ++end) {
    for (Bond& bond : prices.bonds[end]) {
      const auto [known, unknown] = costs.try_emplace(std::minmax(end, bond.to), 0.0F);
      if (unknown) {
        const auto& [a, b] = known->first;
        const PairFeatures pair =
            pair_features(a, b, offers.links().at(known->first), strands, cover);
        known->second = network.link(pair, {ends[a], side_features(a, b, strands, cover)},
                                     {ends[b], side_features(b, a, strands, cover)});
      }
      bond.cost = known->second;
    }
    std::stable_sort(prices.bonds[end].begin(), prices.bonds[end].end(), cheaper);
  }
  return prices;
}

}  // namespace

Link link_between(int from, int to, const Strands& strands, const Cover& cover,
                  const LinkTerms& weights, float most, float elsewhere) {
  return best_link(strands.end(from), strands.end(to), cover,
                   config_between(from, to, strands, weights, elsewhere), most);
}

std::vector<Eigen::Vector2f> points_between(int from, int to, const Strands& strands,
                                            const Cover& cover) {
  return link_points(strands.end(from), strands.end(to), cover,
                     config_between(from, to, strands, weights_of(strands), 0));
}

Prices prices_of(const Strands& strands, const Region& region, const Frame& frame,
                 const Opinion& opinion, bool ring) {
  const Cover cover(region, frame, strands.width_px, strands.seen);
  const Offers offers(strands, cover, opinion, ring);
  return strands.links != nullptr ? by_network(offers, strands, cover, opinion)
                                  : by_energy(offers, strands, opinion);
}

}  // namespace flowdlo::path
