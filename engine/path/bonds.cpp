#include "path/bonds.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>

#include "path/cover.hpp"
#include "path/gap_curve.hpp"
#include "path/limits.hpp"
#include "path/walk_costs.hpp"

namespace flowdlo::path {
namespace {

using Eigen::Vector2f;

constexpr std::size_t kBondsAnEnd = 8;
constexpr std::size_t kMostTips = 96;
constexpr std::size_t kMostPartners = 64;  // of an end at a crossing
constexpr float kMostBending = 20.0F;
constexpr float kChangeSides = 4.0F;
constexpr float kKeepSides = 1.0F;
constexpr float kSharedWidths = 5.0F;   // longest strand of one width that a second one may lie on
constexpr float kHidingWidths = 15.0F;  // or hide behind,
constexpr float kBehindWidths = 2.5F;   // so far at least
constexpr float kSharing = 0.6F;        // costs this
constexpr float kLongWidths = 6.0F;     // bridges from this length on,
constexpr float kCurved = 0.6F;         // or that turn by this angle (rad)
constexpr float kKnownWidths = 3.0F;    // strands shorter than this are trusted less,
constexpr float kLeastTrust = 0.35F;    // down to this
constexpr float kGapWidths = 6.0F;      // no curve costs less a width than one in so many
constexpr float kGapStart = 0.5F;       // a gap costs this beside its curve
constexpr float kGapAtCrossing = 1.5F;  // more, where one side is no tip
constexpr float kGapAtCutCrossing = 0.3F;  // less, where an occluder begins there
constexpr float kMostGapCost = 16.0F;      // or what leaving out a longer strand costs
constexpr float kDepthWeight = 1.5F;
constexpr float kMostDepthCost = 5.0F;
constexpr float kDepthNoise_m = 0.002F;
constexpr float kDepthNoise = 0.18F;    // metres of depth a metre through a crossing
constexpr float kGapDepthNoise = 0.3F;  // and across a gap
constexpr float kRounding = 1e-3F;      // of a cost

float angle(const Vector2f& from, const Vector2f& to) {
  return std::atan2(from.x() * to.y() - from.y() * to.x(), from.dot(to));
}

// Bending energy of the cubic between two ends, times its length: free of units. For small
// angles a and b to the chord it is 4 (a^2 + a b + b^2).
float bending(const StrandEnd& from, const StrandEnd& to, float scale_px) {
  const Vector2f chord = to.point_px - from.point_px;
  const float length = chord.norm();
  const float turn = angle(from.outward, -to.outward);
  if (length < 0.5F * scale_px) return std::min(kMostBending, turn * turn);
  const float a = angle(chord, from.outward);
  const float b = angle(chord, -to.outward);
  return std::min(kMostBending, 4 * (a * a + a * b + b * b));
}

// How badly the depths on both sides fit one smooth strand; tends to a limit, for sensors lie.
float depth_misfit(const StrandEnd& from, const StrandEnd& to, float width_px, float fx, bool gap) {
  if (from.depth_m <= 0 || to.depth_m <= 0 || fx <= 0) return 0;
  const float length_px = (to.point_px - from.point_px).norm();
  const float metres_per_px = 0.5F * (from.depth_m + to.depth_m) / fx;
  const float expected = 0.5F * length_px * (from.slope_per_px - to.slope_per_px);
  const float off = std::abs(to.depth_m - from.depth_m - expected);
  const float per_length = gap ? kGapDepthNoise : kDepthNoise;
  const float noise = kDepthNoise_m + (0.5F * width_px + per_length * length_px) * metres_per_px;
  const float ratio = off / noise;
  return kMostDepthCost * (1 - std::exp(-kDepthWeight * ratio * ratio / kMostDepthCost));
}

// What it takes to pass along a bridge. On a long or curved one the bend of the bridge itself is
// free: both strands follow it. Strands that lie beside each other all along, nowhere on each
// other, do not change sides; those that do lie on each other rather do.
float passing(const Strands& strands, const Bridge& bridge, const StrandEnd& from,
              const StrandEnd& to) {
  const auto count = static_cast<int>(bridge.points_px.size());
  const int reach = std::min(count - 1, static_cast<int>(1.5F * strands.scale_px));
  const bool forwards = bridge.node[0] == from.node;
  const StrandEnd& front = forwards ? from : to;
  const StrandEnd& back = forwards ? to : from;
  const Vector2f& first = bridge.points_px.front();
  const Vector2f& last = bridge.points_px.back();
  const Vector2f sets_out = bridge.points_px[reach] - first;
  const Vector2f arrives = last - bridge.points_px[count - 1 - reach];
  const float length = static_cast<float>(count) / strands.scale_px;

  float cost = bending(from, to, strands.scale_px);
  if (length > kLongWidths || std::abs(angle(sets_out, arrives)) > kCurved) {
    const float a = angle(front.outward, sets_out);
    const float b = angle(arrives, -back.outward);
    cost = std::min(cost, a * a + b * b);
  }
  const bool left_at_front = angle(sets_out, front.point_px - front.fork_px) > 0;
  const bool left_at_back = angle(arrives, back.point_px - back.fork_px) > 0;
  const float wide = bridge.narrowest_px / strands.width_px;
  const float sure = std::clamp((length - 1.5F) / 1.5F, 0.0F, 1.0F);
  const float beside = std::clamp((wide - 1.25F) / 0.4F, 0.0F, 1.0F);
  const float upon = std::clamp((1.25F - wide) / 0.2F, 0.0F, 1.0F);
  return cost + sure * (left_at_front == left_at_back ? kKeepSides * upon : kChangeSides * beside);
}

class Builder {
 public:
  Builder(const Strands& strands, const Region& region, const Frame& frame, bool several)
      : strands_(strands),
        frame_(frame),
        several_(several),
        cover_(region, frame, strands.width_px),
        bonds_(2 * strands.list.size()),
        kept_(bonds_.size()) {
    for (const Bridge& bridge : strands.bridges) {
      bridges_.try_emplace({bridge.node[0], bridge.node[1]}, &bridge);
      bridges_.try_emplace({bridge.node[1], bridge.node[0]}, &bridge);
    }
    for (int id = 0; id < static_cast<int>(bonds_.size()); ++id) {
      if (!strands_.end(id).tip()) met_[strands_.end(id).crossing].push_back(id);
    }
  }

  std::vector<std::vector<Bond>> run() {
    through_crossings();
    along_shared_strands();
    across_gaps();
    for (auto& list : bonds_) {
      std::sort(list.begin(), list.end(), [](const Bond& a, const Bond& b) {
        return a.cost != b.cost ? a.cost < b.cost : a.to < b.to;
      });
      if (list.size() > kBondsAnEnd) list.resize(kBondsAnEnd);
    }
    return std::move(bonds_);
  }

 private:
  void add(int a, int b, float cost, bool gap) {
    for (const auto& [end, other] : {std::pair{a, b}, {b, a}}) {
      bonds_[end].push_back({other, cost, gap});
      std::vector<float>& kept = kept_[end];
      kept.insert(std::upper_bound(kept.begin(), kept.end(), cost), cost);
      if (kept.size() > kBondsAnEnd) kept.pop_back();
    }
  }

  // What a bond of that end may cost to be kept, as things stand.
  [[nodiscard]] float most_at(int end) const {
    const std::vector<float>& kept = kept_[end];
    return kept.size() < kBondsAnEnd ? std::numeric_limits<float>::max() : kept.back();
  }

  // The ends that meet at a crossing; of more than a rope can have there, the first.
  [[nodiscard]] std::span<const int> some_at(int crossing) {
    const std::vector<int>& ends = met_[crossing];
    return {ends.data(), std::min<std::size_t>(ends.size(), kMostAtCrossing)};
  }

  void through_crossings() {
    for (const auto& [crossing, ends] : met_) {
      for (std::size_t i = 0; i < ends.size(); ++i) {
        const std::size_t last = std::min(ends.size(), i + 1 + kMostPartners);
        for (std::size_t j = i + 1; j < last; ++j) {
          const StrandEnd& a = strands_.end(ends[i]);
          const StrandEnd& b = strands_.end(ends[j]);
          const auto bridge = a.node == b.node ? bridges_.end() : bridges_.find({a.node, b.node});
          const float bend = bridge != bridges_.end() ? passing(strands_, *bridge->second, a, b)
                                                      : bending(a, b, strands_.scale_px);
          const float trust = std::min(trust_in(ends[i]), trust_in(ends[j]));
          const float depth = misfit(a, b, false);
          add(ends[i], ends[j], trust * bend + depth, false);
        }
      }
    }
  }

  // Where crossings are crowded, two strands may lie on or beside each other for a while and look
  // like one strand between two crossings. One of them takes it, the other passes along it.
  void along_shared_strands() {
    for (int s = 0; s < static_cast<int>(strands_.list.size()); ++s) {
      const StrandEnd& front = strands_.end(2 * s);
      const StrandEnd& back = strands_.end(2 * s + 1);
      if (front.tip() || back.tip() || front.crossing == back.crossing) continue;
      const float most = kSharedWidths * strands_.scale_px;
      const bool brief =
          (front.node_px - back.node_px).norm() <= most && strands_.list[s].covers_px <= most;
      for (const int from : some_at(front.crossing)) {
        for (const int to : some_at(back.crossing)) {
          if (brief || strands_.list[s].doubled || behind(s, from, to)) pass_along(s, from, to);
        }
      }
    }
  }

  // Whether `from` and `to` lie so far behind the strand between them that it may hide what joins
  // them: a loop in the air seen edge-on.
  [[nodiscard]] bool behind(int shared, int from, int to) const {
    if (strands_.list[shared].covers_px > kHidingWidths * strands_.scale_px) return false;
    const auto hides = [&](const StrandEnd& near, const StrandEnd& far) {
      const float width_m = strands_.width_px * near.depth_m / std::max(1.0F, frame_.intrinsics.fx);
      return near.depth_m > 0 && far.depth_m > near.depth_m + kBehindWidths * width_m;
    };
    return hides(strands_.end(2 * shared), strands_.end(from)) &&
           hides(strands_.end(2 * shared + 1), strands_.end(to));
  }

  void pass_along(int shared, int from, int to) {
    if (from / 2 == shared || to / 2 == shared || from / 2 == to / 2) return;
    const StrandEnd& a = strands_.end(from);
    const StrandEnd& b = strands_.end(to);
    float bend = bending(a, b, strands_.scale_px);
    const bool brief = strands_.list[shared].covers_px <= kSharedWidths * strands_.scale_px;
    if (strands_.list[shared].doubled || !brief) {  // its own bend is free: both follow it
      const float in = angle(a.outward, -strands_.end(2 * shared).outward);
      const float out = angle(strands_.end(2 * shared + 1).outward, -b.outward);
      bend = std::min(bend, in * in + out * out);
    }
    const float trust = std::min(trust_in(from), trust_in(to));
    const float depth = misfit(a, b, false);
    add(from, to, kSharing + trust * bend + depth, false);
  }

  [[nodiscard]] float misfit(const StrandEnd& a, const StrandEnd& b, bool gap) const {
    return several_ ? depth_misfit(a, b, strands_.width_px, frame_.intrinsics.fx, gap) : 0;
  }

  // A stump's direction is hardly known.
  [[nodiscard]] float trust_in(int end) const {
    const auto length = static_cast<float>(strands_.list[end / 2].points_px.size());
    return std::clamp(length / (kKnownWidths * strands_.scale_px), kLeastTrust, 1.0F);
  }

  void across_gaps() {
    std::vector<int> tips;
    std::vector<int> crossed;  // an occluder may begin right behind a crossing
    for (int id = 0; id < static_cast<int>(bonds_.size()); ++id) {
      if (strands_.list[id / 2].ring) continue;
      (strands_.end(id).tip() ? tips : crossed).push_back(id);
    }
    keep_longest(tips, kMostTips);
    keep_longest(crossed, kMostTips);
    std::vector<Gap> gaps;
    for (std::size_t i = 0; i < tips.size(); ++i) {
      for (std::size_t j = i + 1; j < tips.size(); ++j) consider(tips[i], tips[j], 0, gaps);
      for (const int end : crossed) consider(tips[i], end, extra_at(end), gaps);
    }
    for (std::size_t i = 0; i < crossed.size(); ++i) {
      for (std::size_t j = i + 1; j < crossed.size(); ++j) {
        const StrandEnd& a = strands_.end(crossed[i]);
        const StrandEnd& b = strands_.end(crossed[j]);
        if (!a.cut || !b.cut || a.crossing == b.crossing) continue;
        consider(crossed[i], crossed[j], extra_at(crossed[i]) + extra_at(crossed[j]), gaps);
      }
    }
    // The short ones first: most others then cost more than what is kept.
    std::stable_sort(gaps.begin(), gaps.end(),
                     [](const Gap& a, const Gap& b) { return a.straight < b.straight; });
    for (const Gap& gap : gaps) link(gap);
  }

  [[nodiscard]] float extra_at(int end) const {
    return strands_.end(end).cut ? kGapAtCutCrossing : kGapAtCrossing;
  }

  void keep_longest(std::vector<int>& ends, std::size_t most) const {
    if (ends.size() <= most) return;
    std::stable_sort(ends.begin(), ends.end(), [&](int a, int b) {
      return strands_.list[a / 2].covers_px > strands_.list[b / 2].covers_px;
    });
    ends.resize(most);
  }

  // A link over a gap that may be worth its cost.
  struct Gap {
    int from = 0;
    int to = 0;
    float extra = 0;     // what it costs beside what lies between the ends
    float straight = 0;  // what it costs at least
    float most = 0;      // and at most
  };

  void consider(int a, int b, float extra, std::vector<Gap>& gaps) const {
    if (a / 2 == b / 2 && !several_) return;
    const float apart = (strands_.end(a).point_px - strands_.end(b).point_px).norm();
    const float straight = kGapStart + apart / (kGapWidths * strands_.scale_px);
    const float most = most_for(a, b);
    if (straight < most) gaps.push_back({a, b, extra, straight, most});
  }

  void link(const Gap& gap) {
    const StrandEnd& a = strands_.end(gap.from);
    const StrandEnd& b = strands_.end(gap.to);
    const float depth = misfit(a, b, true);
    const float kept = std::max(most_at(gap.from), most_at(gap.to));
    const float curve_most = std::min(gap.most, kept) - gap.extra - kGapStart - depth + kRounding;
    const float curve = gap_cost(a, b, cover_, strands_.scale_px, curve_most);
    const float cost = gap.extra + (kGapStart + curve + depth);
    if (curve < curve_most && cost < gap.most) add(gap.from, gap.to, cost, true);
  }

  // No gap costs more than leaving out what lies beyond it.
  [[nodiscard]] float most_for(int a, int b) const {
    const float covers_px =
        std::max(strands_.list[a / 2].covers_px, strands_.list[b / 2].covers_px);
    return std::max(kMostGapCost, kLeftOutCost * covers_px / strands_.scale_px);
  }

  const Strands& strands_;
  const Frame& frame_;
  bool several_;
  Cover cover_;
  std::vector<std::vector<Bond>> bonds_;
  std::vector<std::vector<float>> kept_;                  // [ends] costs that are kept, ascending
  std::map<std::pair<int, int>, const Bridge*> bridges_;  // between two nodes
  std::map<int, std::vector<int>> met_;                   // crossing to the ends there
};

}  // namespace

std::vector<std::vector<Bond>> make_bonds(const Strands& strands, const Region& region,
                                          const Frame& frame, bool several) {
  return Builder(strands, region, frame, several).run();
}

}  // namespace flowdlo::path
