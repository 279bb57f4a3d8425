#include "recording/stamp_match.hpp"

#include <algorithm>
#include <cstdlib>
#include <numeric>

namespace flowdlo::recording {
namespace {

// Indices in the order of their stamps; of equal ones the first that came.
std::vector<std::size_t> sorted_order(std::span<const std::int64_t> stamps) {
  std::vector<std::size_t> order(stamps.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return stamps[a] < stamps[b]; });
  return order;
}

// Place in `order` of the stamp nearest to `moment`. `order` is not empty.
std::size_t nearest(std::span<const std::int64_t> stamps, const std::vector<std::size_t>& order,
                    std::int64_t moment) {
  const auto after = std::lower_bound(
      order.begin(), order.end(), moment,
      [&](std::size_t index, std::int64_t value) { return stamps[index] < value; });
  if (after == order.begin()) return 0;
  const auto before = std::prev(after);
  const bool later_is_nearer =
      after != order.end() && stamps[*after] - moment < moment - stamps[*before];
  const std::int64_t stamp = stamps[later_is_nearer ? *after : *before];
  const auto first =  // of equal stamps
      std::lower_bound(
          order.begin(), order.end(), stamp,
          [&](std::size_t index, std::int64_t value) { return stamps[index] < value; });
  return static_cast<std::size_t>(first - order.begin());
}

}  // namespace

std::vector<std::optional<std::size_t>> match_stamps(std::span<const std::int64_t> leader,
                                                     std::span<const std::int64_t> other,
                                                     std::int64_t tolerance_ns) {
  std::vector<std::optional<std::size_t>> partners(leader.size());
  if (leader.empty() || other.empty()) return partners;
  const auto leader_order = sorted_order(leader);
  const auto other_order = sorted_order(other);
  for (std::size_t i = 0; i < leader.size(); ++i) {
    const std::size_t partner = other_order[nearest(other, other_order, leader[i])];
    const std::size_t back = leader_order[nearest(leader, leader_order, other[partner])];
    if (back == i && std::abs(other[partner] - leader[i]) <= tolerance_ns) partners[i] = partner;
  }
  return partners;
}

std::size_t latest_until(std::span<const std::int64_t> stamps, std::int64_t moment) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    const bool fits = stamps[i] <= moment;
    const bool best_fits = stamps[best] <= moment;
    if (fits ? !best_fits || stamps[i] > stamps[best] : !best_fits && stamps[i] < stamps[best]) {
      best = i;
    }
  }
  return best;
}

}  // namespace flowdlo::recording
