#include "path/pairings.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <queue>
#include <utility>

namespace flowdlo::path {
namespace {

constexpr int kPriceRounds = 8;
constexpr std::size_t kMostStates = 20000;  // of one group
constexpr std::size_t kBeamWidth = 32;

using Word = std::uint64_t;

// What goes together in one item's view.
struct Partner {
  int item = 0;
  int pair = 0;
  float excess = 0;  // cost beyond both items' prices
};

struct Problem {
  std::vector<std::vector<Partner>> partners;  // [items] cheapest first
  std::vector<float> alone;                    // [items] cost beyond the item's price
  float priced = 0;                            // sum of all prices
};

// The dual of the linear programme: no pair costs less than its items' prices, no item alone less
// than its own. Each price in turn is raised as far as that allows.
std::vector<float> prices_of(const std::vector<float>& alone,
                             const std::vector<std::vector<Partner>>& partners,
                             const std::vector<Pair>& pairs) {
  std::vector<float> price = alone;
  for (std::size_t i = 0; i < price.size(); ++i) {
    for (const Partner& with : partners[i])
      price[i] = std::min(price[i], 0.5F * pairs[with.pair].cost);
  }
  for (int round = 0; round < kPriceRounds; ++round) {
    for (std::size_t i = 0; i < price.size(); ++i) {
      float most = alone[i];
      for (const Partner& with : partners[i]) {
        most = std::min(most, pairs[with.pair].cost - price[with.item]);
      }
      price[i] = std::max(price[i], most);
    }
  }
  return price;
}

Problem priced(const std::vector<float>& alone, const std::vector<Pair>& pairs) {
  Problem problem;
  problem.partners.resize(alone.size());
  for (int i = 0; i < static_cast<int>(pairs.size()); ++i) {
    const auto& [a, b, cost] = pairs[i];
    if (a == b || cost >= alone[a] + alone[b]) continue;
    problem.partners[a].push_back({b, i});
    problem.partners[b].push_back({a, i});
  }
  const std::vector<float> price = prices_of(alone, problem.partners, pairs);
  for (std::size_t i = 0; i < alone.size(); ++i) {
    problem.priced += price[i];
    problem.alone.push_back(std::max(0.0F, alone[i] - price[i]));
    for (Partner& with : problem.partners[i]) {
      with.excess = std::max(0.0F, pairs[with.pair].cost - price[i] - price[with.item]);
    }
    std::stable_sort(problem.partners[i].begin(), problem.partners[i].end(),
                     [](const Partner& a, const Partner& b) { return a.excess < b.excess; });
  }
  return problem;
}

// The items that pairs join, directly or through others, and things too where chains matter.
std::vector<std::vector<int>> groups_of(const Problem& problem, bool of_things) {
  std::vector<std::vector<int>> groups;
  std::vector<std::uint8_t> seen(problem.alone.size(), 0);
  for (std::size_t first = 0; first < seen.size(); ++first) {
    if (seen[first] != 0) continue;
    std::vector<int> group{static_cast<int>(first)};
    seen[first] = 1;
    for (std::size_t i = 0; i < group.size(); ++i) {
      const auto add = [&](int item) {
        if (std::exchange(seen[item], 1) == 0) group.push_back(item);
      };
      for (const Partner& with : problem.partners[group[i]]) add(with.item);
      if (of_things) add(group[i] ^ 1);
    }
    groups.push_back(std::move(group));
  }
  return groups;
}

// Pairs chosen in one group, and what they cost beyond the prices.
struct Choice {
  std::vector<int> pairs;
  float excess = 0;
};

// One item after the other is paired or left alone.
class GroupSearch {
 public:
  GroupSearch(const Problem& problem, const std::vector<Pair>& pairs, const std::vector<int>& group,
              std::size_t count, bool closed)
      : problem_(problem),
        pairs_(pairs),
        group_(group),
        count_(count),
        closed_(closed),
        words_((group.size() + 63) / 64),
        place_(problem.alone.size(), 0),
        other_end_(closed ? 0 : problem.alone.size(), 0) {
    for (std::size_t i = 0; i < group.size(); ++i) place_[group[i]] = static_cast<int>(i);
  }

  std::vector<Choice> run() {
    best_first();
    if (found_.empty()) beam();
    return std::move(found_);
  }

 private:
  struct State {
    int parent = -1;
    int pair = -1;  // the last choice; -1: alone
    int next = 0;   // place of the first item that is not settled
    float excess = 0;
  };

  [[nodiscard]] bool settled(std::size_t state, int place) const {
    return (settled_[state * words_ + static_cast<std::size_t>(place) / 64] >> (place % 64) & 1) !=
           0;
  }
  void settle(std::size_t state, int place) {
    settled_[state * words_ + static_cast<std::size_t>(place) / 64] |= Word{1} << (place % 64);
  }

  int push(int parent, int pair, int other, float excess) {
    State state{parent, pair, 0, excess};
    const std::size_t id = states_.size();
    if (parent < 0) {
      settled_.resize(words_, 0);
    } else {
      const auto from = static_cast<std::size_t>(parent);
      for (std::size_t w = 0; w < words_; ++w) settled_.push_back(settled_[from * words_ + w]);
      state.excess += states_[from].excess;
      state.next = states_[from].next;
      settle(id, state.next);
      if (other >= 0) settle(id, place_[other]);
    }
    while (state.next < static_cast<int>(group_.size()) && settled(id, state.next)) ++state.next;
    states_.push_back(state);
    return static_cast<int>(id);
  }

  // [items] where the chain ends that begins with each item that ends one.
  void find_ends(int id) {
    for (const int item : group_) other_end_[item] = item ^ 1;
    for (int at = id; at >= 0; at = states_[at].parent) {
      if (states_[at].pair < 0) continue;
      const auto& [a, b, cost] = pairs_[states_[at].pair];
      const int first = other_end_[a];
      const int last = other_end_[b];
      other_end_[first] = last;
      other_end_[last] = first;
    }
  }

  template <class Offer>
  void expand(int id, const Offer& offer) {
    const int item = group_[states_[id].next];
    if (!closed_) find_ends(id);
    offer(push(id, -1, -1, problem_.alone[item]));
    for (const Partner& with : problem_.partners[item]) {
      if (settled(static_cast<std::size_t>(id), place_[with.item])) continue;
      const bool closes = !closed_ && with.item != (item ^ 1) && other_end_[item] == with.item;
      if (!closes) offer(push(id, with.pair, with.item, with.excess));
    }
  }

  [[nodiscard]] bool done(int id) const {
    return states_[id].next == static_cast<int>(group_.size());
  }

  void finish(int id) {
    Choice choice{{}, states_[id].excess};
    for (int at = id; at >= 0; at = states_[at].parent) {
      if (states_[at].pair >= 0) choice.pairs.push_back(states_[at].pair);
    }
    found_.push_back(std::move(choice));
  }

  // What is paid so far never overestimates: the rest costs at least its prices.
  void best_first() {
    using Entry = std::pair<float, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
    const auto offer = [&](int id) { open.emplace(states_[id].excess, -id); };  // the last first:
    offer(push(-1, -1, -1, 0));                                                 // it is deeper
    while (!open.empty() && found_.size() < count_ && states_.size() < kMostStates) {
      const int id = -open.top().second;
      open.pop();
      if (done(id)) {
        finish(id);
      } else {
        expand(id, offer);
      }
    }
  }

  // Those first that have paid least for each item that is settled.
  void beam() {
    states_.clear();
    settled_.clear();
    std::vector<int> level{push(-1, -1, -1, 0)};
    std::vector<int> ends;
    while (!level.empty()) {
      std::vector<int> next;
      for (const int id : level) {
        if (done(id)) {
          ends.push_back(id);
        } else {
          expand(id, [&](int child) { next.push_back(child); });
        }
      }
      std::stable_sort(next.begin(), next.end(),
                       [&](int a, int b) { return states_[a].excess < states_[b].excess; });
      if (next.size() > kBeamWidth) next.resize(kBeamWidth);
      level = std::move(next);
    }
    std::stable_sort(ends.begin(), ends.end(),
                     [&](int a, int b) { return states_[a].excess < states_[b].excess; });
    if (ends.size() > count_) ends.resize(count_);
    for (const int id : ends) finish(id);
  }

  const Problem& problem_;
  const std::vector<Pair>& pairs_;
  const std::vector<int>& group_;
  std::size_t count_;
  bool closed_;  // chains may be
  std::size_t words_;
  std::vector<int> place_;      // [items] in the group
  std::vector<int> other_end_;  // of the chain that an item ends, for the state that is expanded
  std::vector<State> states_;
  std::vector<Word> settled_;  // [states, words_]
  std::vector<Choice> found_;
};

// The cheapest sums of one choice from either list.
std::vector<Choice> combined(const std::vector<Choice>& left, const std::vector<Choice>& right,
                             std::size_t count) {
  std::vector<std::pair<float, std::pair<std::size_t, std::size_t>>> sums;
  for (std::size_t i = 0; i < left.size(); ++i) {
    for (std::size_t j = 0; j < right.size() && (i + 1) * (j + 1) <= count; ++j) {
      sums.push_back({left[i].excess + right[j].excess, {i, j}});
    }
  }
  std::sort(sums.begin(), sums.end());
  if (sums.size() > count) sums.resize(count);
  std::vector<Choice> result;
  for (const auto& [excess, from] : sums) {
    Choice choice{left[from.first].pairs, excess};
    const auto& added = right[from.second].pairs;
    choice.pairs.insert(choice.pairs.end(), added.begin(), added.end());
    result.push_back(std::move(choice));
  }
  return result;
}

}  // namespace

std::vector<Pairing> cheapest_pairings(const std::vector<float>& alone,
                                       const std::vector<Pair>& pairs, std::size_t count,
                                       bool closed) {
  const Problem problem = priced(alone, pairs);
  std::vector<Choice> all{Choice{}};
  for (const auto& group : groups_of(problem, !closed)) {
    if (group.size() == 1) {
      for (Choice& choice : all) choice.excess += problem.alone[group.front()];
      continue;
    }
    all = combined(all, GroupSearch(problem, pairs, group, count, closed).run(), count);
  }
  std::vector<Pairing> result;
  for (const Choice& choice : all) {
    Pairing pairing{std::vector<int>(alone.size(), -1), problem.priced + choice.excess};
    for (const int pair : choice.pairs) {
      pairing.pair_of[pairs[pair].a] = pair;
      pairing.pair_of[pairs[pair].b] = pair;
    }
    result.push_back(std::move(pairing));
  }
  return result;
}

}  // namespace flowdlo::path
