// Dice: the random draws of one sample, the same on every machine.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <random>

namespace flowdlo::strand {

inline constexpr float kPi = std::numbers::pi_v<float>;

class Dice {
 public:
  Dice(std::uint64_t seed, std::uint64_t number)
      : random_(seed * 0xD1342543DE82EF95ULL + number * 0x9E3779B97F4A7C15ULL + 1) {}

  /// [low, high).
  float uniform(float low, float high) {
    return low + (high - low) * static_cast<float>(static_cast<double>(random_() >> 11U) * 0x1p-53);
  }
  /// Of deviation 1.
  float gaussian() {
    const float radius = std::sqrt(-2 * std::log(std::max(uniform(0, 1), 1e-9F)));
    return radius * std::cos(uniform(0, 2 * kPi));
  }
  bool chance(double share) { return static_cast<double>(uniform(0, 1)) < share; }
  int integer(int low, int high) {  // both included
    const auto count = static_cast<std::uint64_t>(high - low + 1);
    return low + static_cast<int>(random_() % count);
  }
  /// Logarithms evenly spread.
  float factor(float low, float high) { return std::exp(uniform(std::log(low), std::log(high))); }
  std::uint64_t word() { return random_(); }

 private:
  std::mt19937_64 random_;
};

}  // namespace flowdlo::strand
