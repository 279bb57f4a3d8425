#include "path/search.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <queue>
#include <unordered_map>
#include <utility>

namespace flowdlo::path {
namespace {

constexpr float kEndReach = 2;  // widths within which a place means an end
constexpr std::uint64_t kMix = 0x9E3779B97F4A7C15ULL;
constexpr std::size_t kMostStates = 24000;
constexpr std::size_t kBeamWidth = 24;
constexpr std::size_t kMostBeamSteps = 30000;

struct State {
  int parent = -1;
  int enter = -1;      // the end by which the last strand was entered
  float paid = 0;      // bonds and the start
  float left = 0;      // cost of all that is not yet covered
  float at_least = 0;  // bound on what the rest will cost
};

class Searcher {
 public:
  Searcher(const Strands& strands, const std::vector<std::vector<Bond>>& bonds, int count,
           const std::vector<Eigen::Vector2f>& ends)
      : strands_(strands),
        bonds_(bonds),
        count_(static_cast<std::size_t>(count)),
        words_((strands.list.size() + 63) / 64) {
    const std::size_t n = strands.list.size();
    uncovered_.resize(n);
    bound_.resize(n);
    for (std::size_t s = 0; s < n; ++s) {
      uncovered_[s] = left_out_energy(strands.list[s], strands);
      bound_[s] = uncovered_[s];
      for (int side = 0; side < 2; ++side) {
        const auto& list = bonds[2 * s + side];
        if (!list.empty()) bound_[s] = std::min(bound_[s], list.front().cost);
      }
      total_ += uncovered_[s];
      total_bound_ += bound_[s];
    }
    for (int end = 0; end < static_cast<int>(2 * n); ++end) stop_.push_back(stop_cost(end, ends));
  }

  std::vector<Traversal> run() {
    beam();
    clear();
    best_first();
    std::vector<Traversal> result;
    for (auto& [key, traversal] : found_) result.push_back(std::move(traversal));
    std::stable_sort(result.begin(), result.end(),
                     [](const Traversal& a, const Traversal& b) { return a.cost < b.cost; });
    if (result.size() > count_) result.resize(count_);
    return result;
  }

 private:
  using Word = std::uint64_t;

  void clear() {
    states_.clear();
    used_.clear();
    visits_.clear();
  }

  [[nodiscard]] float stop_cost(int end, const std::vector<Eigen::Vector2f>& known) const {
    const float cost = strands_.end(end).end_cost;
    if (known.empty()) return cost;
    float near = 0;
    for (const Eigen::Vector2f& place : known) {
      const float off = (strands_.end(end).point_px - place).norm() / strands_.scale_px;
      near = std::max(near, std::exp(-0.5F * off * off / (kEndReach * kEndReach)));
    }
    return (1 - near) * (cost + kElsewhere);
  }
  [[nodiscard]] float goal_cost(const State& state) const {
    return state.paid + stop_[state.enter ^ 1] + state.left;
  }

  int push_start(int enter) {
    const std::size_t s = static_cast<std::size_t>(enter) / 2;
    states_.push_back({-1, enter, stop_[enter], total_ - uncovered_[s], total_bound_ - bound_[s]});
    used_.resize(used_.size() + words_, 0);
    used_[used_.size() - words_ + s / 64] |= Word{1} << (s % 64);
    return static_cast<int>(states_.size()) - 1;
  }

  // Returns -1 when the bond's strand is used already.
  int push_child(int parent, const Bond& bond) {
    const std::size_t s = static_cast<std::size_t>(bond.to) / 2;
    const std::size_t from = static_cast<std::size_t>(parent) * words_;
    if ((used_[from + s / 64] >> (s % 64) & 1) != 0) return -1;
    const State& before = states_[parent];
    states_.push_back({parent, bond.to, before.paid + bond.cost, before.left - uncovered_[s],
                       std::max(0.0F, before.at_least - bound_[s])});
    for (std::size_t w = 0; w < words_; ++w) used_.push_back(used_[from + w]);
    used_[used_.size() - words_ + s / 64] |= Word{1} << (s % 64);
    return static_cast<int>(states_.size()) - 1;
  }

  // False once a state with the same end and the same strands has been seen `count` times.
  bool visit(int id) {
    std::uint64_t hash = (static_cast<std::uint64_t>(states_[id].enter) + 1) * kMix;
    for (std::size_t w = 0; w < words_; ++w) {
      hash = (hash ^ used_[static_cast<std::size_t>(id) * words_ + w]) * kMix;
      hash ^= hash >> 29;
    }
    return ++visits_[hash] <= count_;
  }

  void finish(int id) {
    const float cost = goal_cost(states_[id]);
    if (found_.size() >= 8 * count_ && cost > worst_) return;
    Traversal traversal;
    traversal.cost = cost;
    for (int at = id; at >= 0; at = states_[at].parent)
      traversal.enters.push_back(states_[at].enter);
    std::reverse(traversal.enters.begin(), traversal.enters.end());
    std::vector<int> backwards;
    for (auto it = traversal.enters.rbegin(); it != traversal.enters.rend(); ++it) {
      backwards.push_back(*it ^ 1);
    }
    if (backwards < traversal.enters) traversal.enters = backwards;
    auto key = major(traversal.enters);
    const auto [place, added] = found_.try_emplace(std::move(key), traversal);
    if (!added && cost < place->second.cost) place->second = std::move(traversal);
    worst_ = std::max(worst_, cost);
  }

  // The strands that tell traversals apart, in an order that does not depend on the direction.
  [[nodiscard]] std::vector<int> major(const std::vector<int>& enters) const {
    std::vector<int> key;
    std::vector<int> reverse;
    for (const int end : enters) {
      if (strands_.list[end / 2].covers_px >= kMinorWidths * strands_.scale_px) key.push_back(end);
    }
    if (key.empty()) return enters;
    for (auto it = key.rbegin(); it != key.rend(); ++it) reverse.push_back(*it ^ 1);
    return std::min(key, reverse);
  }

  // Level by level, one more strand each; ranks halfway between what is paid and what is left.
  void beam() {
    std::vector<int> level;
    for (int end = 0; end < static_cast<int>(bonds_.size()); ++end) {
      level.push_back(push_start(end));
    }
    while (!level.empty() && states_.size() < kMostBeamSteps) {
      const auto rank = [&](int id) {
        const State& state = states_[id];
        return state.paid + 0.5F * (state.left + state.at_least);
      };
      std::stable_sort(level.begin(), level.end(), [&](int a, int b) { return rank(a) < rank(b); });
      std::vector<int> next;
      std::size_t kept = 0;
      for (const int id : level) {
        if (kept == kBeamWidth) break;
        if (!visit(id)) continue;
        ++kept;
        finish(id);
        for (const Bond& bond : bonds_[states_[id].enter ^ 1]) {
          const int child = push_child(id, bond);
          if (child >= 0) next.push_back(child);
        }
      }
      level = std::move(next);
    }
  }

  void best_first() {
    using Entry = std::pair<float, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    const float limit = found_.empty() ? 0 : bar();
    const auto offer = [&](int id) {
      if (id < 0) return;
      const float bound = states_[id].paid + states_[id].at_least;
      if (bound <= limit) open.emplace(bound, id);
    };
    for (int end = 0; end < static_cast<int>(bonds_.size()); ++end) offer(push_start(end));
    while (!open.empty() && states_.size() < kMostStates) {
      const int id = open.top().second;
      open.pop();
      if (!visit(id)) continue;
      finish(id);
      for (const Bond& bond : bonds_[states_[id].enter ^ 1]) offer(push_child(id, bond));
    }
  }

  // No state that costs more than the last of the best found so far needs to be looked at.
  [[nodiscard]] float bar() const {
    std::vector<float> costs;
    for (const auto& [key, traversal] : found_) costs.push_back(traversal.cost);
    std::sort(costs.begin(), costs.end());
    return costs[std::min(costs.size(), count_) - 1] + 1e-3F;
  }

  const Strands& strands_;
  const std::vector<std::vector<Bond>>& bonds_;
  std::size_t count_;
  std::size_t words_;
  std::vector<float> uncovered_;  // [strands] cost of leaving it out
  std::vector<float> stop_;       // [strands, 2] cost of the rope's ending there
  std::vector<float> bound_;      // [strands] least cost of entering it, or of leaving it out
  float total_ = 0;
  float total_bound_ = 0;
  float worst_ = 0;
  std::vector<State> states_;
  std::vector<Word> used_;  // [states, words_]
  std::unordered_map<std::uint64_t, std::size_t> visits_;
  std::map<std::vector<int>, Traversal> found_;
};

}  // namespace

std::vector<Traversal> search(const Strands& strands, const std::vector<std::vector<Bond>>& bonds,
                              int count, const std::vector<Eigen::Vector2f>& ends) {
  return Searcher(strands, bonds, count, ends).run();
}

}  // namespace flowdlo::path
