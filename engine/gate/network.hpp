// Network: one hidden layer beside a straight way through.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>

namespace flowdlo::gate {

template <std::size_t Size>
[[nodiscard]] double dot(const std::array<double, Size>& a, const std::array<double, Size>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

/// out = straight x + bent tanh(hidden x). All zero it answers zero.
template <std::size_t Inputs, std::size_t Outputs, std::size_t Hidden = 8>
struct Network {
  static constexpr std::size_t kInputs = Inputs;
  static constexpr std::size_t kOutputs = Outputs;
  static constexpr std::size_t kHidden = Hidden;

  std::array<std::array<double, Inputs>, Hidden> hidden{};
  std::array<std::array<double, Hidden>, Outputs> bent{};
  std::array<std::array<double, Inputs>, Outputs> straight{};

  [[nodiscard]] std::array<double, Outputs> operator()(const std::array<double, Inputs>& x) const {
    std::array<double, Hidden> bends{};
    for (std::size_t h = 0; h < Hidden; ++h) bends[h] = std::tanh(dot(hidden[h], x));
    std::array<double, Outputs> out{};
    for (std::size_t k = 0; k < Outputs; ++k) out[k] = dot(straight[k], x) + dot(bent[k], bends);
    return out;
  }
};

}  // namespace flowdlo::gate
