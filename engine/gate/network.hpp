// Network: one hidden layer beside a straight way through.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace flowdlo::gate {

inline constexpr std::size_t kHidden = 8;

/// out = straight x + bent tanh(hidden x). All zero it answers zero.
template <std::size_t Inputs, std::size_t Outputs>
struct Network {
  static constexpr std::size_t kInputs = Inputs;
  static constexpr std::size_t kOutputs = Outputs;

  std::array<std::array<double, Inputs>, kHidden> hidden{};
  std::array<std::array<double, kHidden>, Outputs> bent{};
  std::array<std::array<double, Inputs>, Outputs> straight{};

  [[nodiscard]] std::array<double, Outputs> operator()(const std::array<double, Inputs>& x) const {
    std::array<double, kHidden> bends{};
    for (std::size_t h = 0; h < kHidden; ++h) bends[h] = std::tanh(dot(hidden[h], x));
    std::array<double, Outputs> out{};
    for (std::size_t k = 0; k < Outputs; ++k) out[k] = dot(straight[k], x) + dot(bent[k], bends);
    return out;
  }

 private:
  template <std::size_t Size>
  [[nodiscard]] static double dot(const std::array<double, Size>& a,
                                  const std::array<double, Size>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < Size; ++i) sum += a[i] * b[i];
    return sum;
  }
};

}  // namespace flowdlo::gate
