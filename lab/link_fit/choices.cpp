#include "link_fit/choices.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace flowdlo::lab {
namespace {

class Chooser {
 public:
  explicit Chooser(const LinkSample& sample) : sample_(sample) {
    for (std::size_t i = 0; i < sample.links.size(); ++i) {
      const auto& [a, b] = std::pair(sample.links[i].a, sample.links[i].b);
      numbers_[{a, b}] = sample.ends.size() + i;
      mates_[a].push_back(b);
      mates_[b].push_back(a);
    }
  }

  std::vector<EndChoice> all() const {
    std::vector<EndChoice> choices;
    for (int end = 0; end < static_cast<int>(sample_.ends.size()); ++end) {
      if (partner(end) == kUnknown) continue;
      EndChoice choice{{{}}};
      if (partner(end) >= 0) choice.options.push_back(stopping(end));
      const auto mates = mates_.find(end);
      if (mates == mates_.end()) continue;
      for (const int other : mates->second) {
        if (other != partner(end)) choice.options.push_back(joining(end, other));
      }
      if (choice.options.size() > 1) choices.push_back(std::move(choice));
    }
    return choices;
  }

 private:
  [[nodiscard]] int partner(int end) const {
    return sample_.ends[static_cast<std::size_t>(end)].partner;
  }
  [[nodiscard]] static Change stop(int end, double sign) {
    return {static_cast<std::size_t>(end), sign};
  }
  [[nodiscard]] Change link(int a, int b, double sign) const {
    return {numbers_.at(std::minmax(a, b)), sign};
  }

  /// `end` has lost what it had, and what it was linked to stops.
  void lose(int end, std::vector<Change>& option) const {
    const int had = partner(end);
    if (had == kStops) option.push_back(stop(end, -1));
    if (had < 0) return;
    option.push_back(link(end, had, -1));
    option.push_back(stop(had, 1));
  }

  [[nodiscard]] std::vector<Change> stopping(int end) const {
    std::vector<Change> option;
    lose(end, option);
    option.push_back(stop(end, 1));
    return option;
  }

  [[nodiscard]] std::vector<Change> joining(int end, int other) const {
    std::vector<Change> option;
    lose(end, option);
    option.push_back(link(end, other, 1));
    if (partner(other) != kUnknown) {
      lose(other, option);
    } else {
      option.push_back(stop(other ^ 1, 1));  // where the strand that was in no rope ends
    }
    return option;
  }

  const LinkSample& sample_;
  std::map<std::pair<int, int>, std::size_t> numbers_;
  std::map<int, std::vector<int>> mates_;
};

}  // namespace

std::vector<EndChoice> choices_of(const LinkSample& sample) { return Chooser(sample).all(); }

Truths truths_of(const LinkSample& sample) {
  Truths truths;
  for (const auto& end : sample.ends) {
    truths.known.push_back(end.partner != kUnknown);
    truths.there.push_back(end.partner == kStops);
  }
  for (const auto& link : sample.links) {
    truths.known.push_back(true);
    truths.there.push_back(sample.ends[static_cast<std::size_t>(link.a)].partner == link.b);
  }
  return truths;
}

Judged judge(const EndChoice& choice, std::span<const double> costs, std::span<double> slopes) {
  std::vector<double> sums;
  for (const auto& option : choice.options) {
    double sum = 0;
    for (const Change& change : option) sum += change.sign * costs[change.thing];
    sums.push_back(sum);
  }
  const double least = *std::min_element(sums.begin(), sums.end());
  double total = 0;
  for (const double sum : sums) total += std::exp(least - sum);
  for (std::size_t i = 1; !slopes.empty() && i < sums.size(); ++i) {
    const double likely = std::exp(least - sums[i]) / total;
    for (const Change& change : choice.options[i]) slopes[change.thing] -= likely * change.sign;
  }
  return {std::log(total) - least + sums.front(), sums.front() <= least};
}

}  // namespace flowdlo::lab
