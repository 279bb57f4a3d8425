#include "link_fit/sample.hpp"

#include <algorithm>
#include <limits>
#include <set>
#include <utility>

#include "path/links.hpp"

namespace flowdlo::lab {
namespace {

/// Pairs of ends, the lower one first.
std::set<std::pair<int, int>> pairs_of(const std::vector<std::vector<path::Bond>>& bonds,
                                       const std::vector<int>& partners) {
  std::set<std::pair<int, int>> pairs;
  for (int end = 0; end < static_cast<int>(partners.size()); ++end) {
    const int partner = partners[static_cast<std::size_t>(end)];
    if (partner == kUnknown) continue;
    for (const path::Bond& bond : bonds[static_cast<std::size_t>(end)]) {
      pairs.insert(std::minmax(end, bond.to));
    }
    if (partner >= 0) pairs.insert(std::minmax(end, partner));
  }
  return pairs;
}

}  // namespace

LinkSample sample_of(const Labelled& labelled) {
  const path::Strands& strands = labelled.strands;
  const path::Cover cover(labelled.region, labelled.frame, strands.width_px, strands.seen);
  const auto prices = path::prices_of(strands, labelled.region, labelled.frame, labelled.opinion);
  const auto& weights = strands.several ? path::kSeveralRopesLinks : path::kOneRopeLinks;
  LinkSample sample;
  std::vector<path::EndFeatures> ends;
  for (int end = 0; end < static_cast<int>(labelled.partners.size()); ++end) {
    const auto number = static_cast<std::size_t>(end);
    ends.push_back(path::end_features(end, strands, cover, labelled.opinion.going_on(end)));
    sample.ends.push_back(
        {labelled.partners[number], prices.stops[number], path::stop_features(ends.back())});
  }
  for (const auto& [a, b] : pairs_of(prices.bonds, labelled.partners)) {
    const path::Link link =
        path::link_between(a, b, strands, cover, weights, std::numeric_limits<float>::max(),
                           labelled.opinion.against(a, b));
    const auto pair = path::pair_features(a, b, link, strands, cover);
    const path::LinkSide from{ends[static_cast<std::size_t>(a)],
                              path::side_features(a, b, strands, cover)};
    const path::LinkSide to{ends[static_cast<std::size_t>(b)],
                            path::side_features(b, a, strands, cover)};
    sample.links.push_back({a, b, link.energy, path::link_features(pair, from, to),
                            path::link_features(pair, to, from)});
  }
  return sample;
}

}  // namespace flowdlo::lab
