// Interval: bootstrap confidence intervals over scenes.
#pragma once

#include <cstdint>
#include <span>

namespace flowdlo::eval {

/// A figure and the 2.5 % and 97.5 % points of its resampled values.
struct Interval {
  double value = 0;
  double low = 0;
  double high = 0;
};

inline constexpr int kResamples = 2000;
inline constexpr std::uint64_t kBootstrapSeed = 20261121;

/// Of the mean of `values`; all zero when there are none.
[[nodiscard]] Interval mean_interval(std::span<const double> values, int resamples = kResamples,
                                     std::uint64_t seed = kBootstrapSeed);

/// Of mean(over) / mean(under), resampled in pairs: `over[i]` and `under[i]` belong to one scene.
/// Infinite where the lower mean is 0; all zero when there are no values.
[[nodiscard]] Interval ratio_interval(std::span<const double> over, std::span<const double> under,
                                      int resamples = kResamples,
                                      std::uint64_t seed = kBootstrapSeed);

}  // namespace flowdlo::eval
