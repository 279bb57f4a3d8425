#include "eval/interval.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

namespace flowdlo::eval {
namespace {

constexpr double kTail = 0.025;

// The value at `share` of the sorted `values`, linear in between.
double quantile(const std::vector<double>& values, double share) {
  const double at = share * static_cast<double>(values.size() - 1);
  const auto i = static_cast<std::size_t>(at);
  if (i + 1 >= values.size() || values[i] == values[i + 1]) return values[i];
  const double t = at - static_cast<double>(i);
  return (1 - t) * values[i] + t * values[i + 1];
}

// `figure` takes the sums over the drawn indices.
template <class Figure>
Interval bootstrap(std::span<const double> over, std::span<const double> under, int resamples,
                   std::uint64_t seed, const Figure& figure) {
  const std::size_t count = over.size();
  if (count == 0) return {};
  double over_sum = 0;
  double under_sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    over_sum += over[i];
    under_sum += under[i];
  }
  Interval interval;
  interval.value = figure(over_sum, under_sum);
  std::mt19937_64 engine(seed);  // its sequence is fixed by the standard; distributions are not
  std::vector<double> values;
  for (int k = 0; k < std::max(1, resamples); ++k) {
    over_sum = 0;
    under_sum = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t drawn = engine() % count;
      over_sum += over[drawn];
      under_sum += under[drawn];
    }
    values.push_back(figure(over_sum, under_sum));
  }
  std::sort(values.begin(), values.end());
  interval.low = quantile(values, kTail);
  interval.high = quantile(values, 1 - kTail);
  return interval;
}

}  // namespace

Interval mean_interval(std::span<const double> values, int resamples, std::uint64_t seed) {
  const std::vector<double> ones(values.size(), 1.0);
  return bootstrap(values, ones, resamples, seed,
                   [](double sum, double count) { return sum / count; });
}

Interval ratio_interval(std::span<const double> over, std::span<const double> under, int resamples,
                        std::uint64_t seed) {
  const std::size_t count = std::min(over.size(), under.size());
  return bootstrap(over.first(count), under.first(count), resamples, seed, [](double a, double b) {
    return b > 0 ? a / b : std::numeric_limits<double>::infinity();
  });
}

}  // namespace flowdlo::eval
