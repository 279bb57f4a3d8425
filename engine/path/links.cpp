#include "path/links.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

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

// What lengths between two ends are measured in: how wide the strands are there, for ropes differ,
// and so do the near and the far end of one.
float scale_between(const StrandEnd& a, const StrandEnd& b, const Strands& strands) {
  if (a.look.width_px <= 0 || b.look.width_px <= 0) return strands.scale_px;
  return std::max(kLeastScalePx, 0.5F * (a.look.width_px + b.look.width_px));
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

std::vector<std::vector<Bond>> make_links(const Strands& strands, const Region& region,
                                          const Frame& frame, const Opinion& opinion) {
  const LinkTerms& weights = weights_of(strands);
  const Cover cover(region, frame, strands.width_px, strands.seen);
  const std::vector<int> ends = open_ends(strands);
  std::vector<Nearness> pairs;
  for (std::size_t i = 0; i < ends.size(); ++i) {
    for (std::size_t j = i + 1; j < ends.size(); ++j) {
      if (ends[i] / 2 == ends[j] / 2 && !strands.several) continue;
      const StrandEnd& a = strands.end(ends[i]);
      const StrandEnd& b = strands.end(ends[j]);
      const float apart = (a.point_px - b.point_px).norm();
      const float least = least_energy(apart, weights, scale_between(a, b, strands));
      if (strands.several && a.leaves && b.leaves) continue;
      const float most = most_for(ends[i], ends[j], strands);
      if (least < most) pairs.push_back({ends[i], ends[j], least, most});
    }
  }
  // The short ones first: most others then cost more than what is kept.
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const Nearness& a, const Nearness& b) { return a.least < b.least; });
  std::vector<std::vector<Bond>> links(2 * strands.list.size());
  const auto cheaper = [](const Bond& a, const Bond& b) {
    return a.cost != b.cost ? a.cost < b.cost : a.to < b.to;
  };
  const auto kept = [&](int end) {
    return links[end].size() < kLinksAnEnd ? std::numeric_limits<float>::max()
                                           : links[end].back().cost;
  };
  for (const Nearness& pair : pairs) {
    const float most = std::min(pair.most, std::max(kept(pair.from), kept(pair.to)));
    if (pair.least >= most) continue;
    const Link link = link_between(pair.from, pair.to, strands, cover, weights, most,
                                   opinion.against(pair.from, pair.to));
    if (link.energy >= most) continue;
    for (const auto& [end, other] : {std::pair{pair.from, pair.to}, {pair.to, pair.from}}) {
      auto& list = links[end];
      const Bond bond{other, link.energy};
      list.insert(std::upper_bound(list.begin(), list.end(), bond, cheaper), bond);
      if (list.size() > kLinksAnEnd) list.pop_back();
    }
  }
  return links;
}

}  // namespace flowdlo::path
