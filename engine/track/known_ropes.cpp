#include "track/known_ropes.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <utility>

#include "flowdlo/config.hpp"
#include "track/alignment.hpp"
#include "track/cheapest_assignment.hpp"

namespace flowdlo::track {
namespace {

// Ropes that flicker would else be remembered without end.
constexpr std::size_t kMostMissing = kMostRopes;

/// [found] which of the known each is; none: a rope that was not seen before. `apart_m` is
/// [found, known]; what is farther apart than `most_m` is not one rope.
std::vector<std::optional<std::size_t>> pairs(const std::vector<std::vector<double>>& apart_m,
                                              std::size_t known, double most_m) {
  const std::size_t found = apart_m.size();
  // What cannot be one rope is dearer than all that can.
  const double never_m = 2 * most_m * static_cast<double>(found + known + 1);
  // To be new costs as much as the farthest that a known rope may have moved, and so does to be
  // missing: the rows beyond the found are those of no rope.
  std::vector<std::vector<double>> cost(found + known, std::vector<double>(found + known, 0));
  for (std::size_t row = 0; row < found + known; ++row) {
    for (std::size_t column = 0; column < found + known; ++column) {
      if (row >= found) {
        cost[row][column] = column < known ? most_m : 0;
      } else if (column >= known) {
        cost[row][column] = most_m;
      } else {
        cost[row][column] = apart_m[row][column] <= most_m ? apart_m[row][column] : never_m;
      }
    }
  }
  const std::vector<int> columns = cheapest_assignment(cost);
  std::vector<std::optional<std::size_t>> result(found);
  for (std::size_t f = 0; f < found; ++f) {
    const auto column = static_cast<std::size_t>(columns[f]);
    if (column < known && apart_m[f][column] <= most_m) result[f] = column;
  }
  return result;
}

/// Both ropes' places on crossings as the turned ropes have them, and their new places in the list.
void renumber(std::vector<RopeCrossing>& crossings, const std::vector<Estimate>& before,
              const std::vector<Alignment>& alignments, const std::vector<std::size_t>& place) {
  const auto moved = [&](int& rope, float& at_m) {
    const auto i = static_cast<std::size_t>(rope);
    at_m = static_cast<float>(
        turned_m(static_cast<double>(at_m), before[i].nodes, before[i].closed, alignments[i]));
    rope = static_cast<int>(place[i]);
  };
  for (RopeCrossing& crossing : crossings) {
    moved(crossing.over, crossing.over_at_m);
    moved(crossing.under, crossing.under_at_m);
  }
  std::sort(crossings.begin(), crossings.end(), [](const RopeCrossing& a, const RopeCrossing& b) {
    return std::pair(a.over, a.over_at_m) < std::pair(b.over, b.over_at_m);
  });
}

}  // namespace

TrackedRopes KnownRopes::recognise(Ropes ropes) {
  const std::size_t count = ropes.ropes.size();
  std::vector<std::vector<Alignment>> alignments(count);
  std::vector<std::vector<double>> apart_m(count);
  for (std::size_t f = 0; f < count; ++f) {
    for (const Known& known : known_) {
      const Estimate& rope = ropes.ropes[f];
      alignments[f].push_back(align(rope.nodes, rope.closed && known.closed, known.nodes));
      apart_m[f].push_back(alignments[f].back().apart_m);
    }
  }
  const auto of = pairs(apart_m, known_.size(), config_.most_moved_m);
  std::vector<int> numbers;
  std::vector<Alignment> taken;
  std::vector<Known> unseen = known_;
  for (std::size_t f = 0; f < count; ++f) {
    numbers.push_back(of[f] ? known_[*of[f]].number : next_++);
    taken.push_back(of[f] ? alignments[f][*of[f]] : Alignment{});
  }
  std::erase_if(unseen, [&](const Known& known) {
    return std::find(numbers.begin(), numbers.end(), known.number) != numbers.end();
  });

  std::vector<std::size_t> order(count);  // by number
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return numbers[a] < numbers[b]; });
  std::vector<std::size_t> place(count);
  for (std::size_t i = 0; i < count; ++i) place[order[i]] = i;

  TrackedRopes result;
  renumber(ropes.crossings, ropes.ropes, taken, place);
  for (std::uint16_t& label : ropes.instances) {
    if (label > 0) label = static_cast<std::uint16_t>(place[label - 1U] + 1);
  }
  for (std::size_t f = 0; f < count; ++f) {
    if (of[f]) turn(ropes.ropes[f], taken[f], known_[*of[f]].nodes);
  }
  known_.clear();
  std::vector<Estimate> turned;
  for (const std::size_t f : order) {
    turned.push_back(std::move(ropes.ropes[f]));
    known_.push_back({numbers[f], turned.back().nodes, turned.back().closed, 0});
    result.numbers.push_back(numbers[f]);
  }
  ropes.ropes = std::move(turned);
  result.found = std::move(ropes);
  miss(std::move(unseen));
  for (const Known& known : known_) {
    if (known.missed > 0) result.missing.push_back(known.number);
  }
  std::sort(result.missing.begin(), result.missing.end());
  return result;
}

std::vector<KnownRope> KnownRopes::last_seen() const {
  std::vector<KnownRope> ropes;
  for (const Known& known : known_) {
    if (known.missed == 0) ropes.push_back({known.nodes, known.closed});
  }
  return ropes;
}

void KnownRopes::miss_all() { miss(std::exchange(known_, {})); }

void KnownRopes::miss(std::vector<Known> unseen) {
  for (Known& known : unseen) ++known.missed;
  std::erase_if(unseen, [&](const Known& known) { return known.missed > config_.patience; });
  std::stable_sort(unseen.begin(), unseen.end(),
                   [](const Known& a, const Known& b) { return a.missed < b.missed; });
  if (unseen.size() > kMostMissing) unseen.resize(kMostMissing);
  known_.insert(known_.end(), unseen.begin(), unseen.end());
}

}  // namespace flowdlo::track
