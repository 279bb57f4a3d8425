// Seeded noise: PyTorch's default initialisation by size, Philox by value.
#include <fmt/format.h>

#include <cmath>

#include "random/philox.hpp"
#include "weights/weights.hpp"

namespace flowdlo::weights {
namespace {

constexpr float kNodeDeviation = 0.02F;

std::size_t count_of(const std::vector<int>& shape) {
  std::size_t count = 1;
  for (const int extent : shape) count *= static_cast<std::size_t>(extent);
  return count;
}

bool ends_with(const std::string& text, std::string_view end) {
  return std::string_view{text}.ends_with(end);
}

/// Uniform in (-bound, bound).
void fill_uniform(std::vector<float>& values, double bound, std::uint64_t seed,
                  std::uint64_t stream) {
  for (std::size_t i = 0; i < values.size(); i += 4) {
    const auto words = random::philox(seed, i / 4, stream);
    for (std::size_t k = 0; k < 4 && i + k < values.size(); ++k) {
      values[i + k] = static_cast<float>(bound * (2.0 * random::uniform(words[k]) - 1.0));
    }
  }
}

void fill_gaussian(std::vector<float>& values, float deviation, std::uint64_t seed,
                   std::uint64_t stream) {
  for (std::size_t i = 0; i < values.size(); i += 4) {
    const auto block = random::gaussian(seed, i / 4, stream);
    for (std::size_t k = 0; k < 4 && i + k < values.size(); ++k) {
      values[i + k] = deviation * block[k];
    }
  }
}

}  // namespace

Weights seeded(const Variant& variant, std::uint64_t seed) {
  Weights weights;
  weights.metadata = {
      .name = "seeded-noise",
      .version = "1",
      .training_data = "none",
      .licence = "MIT",
      .notes = fmt::format("Philox noise, not a trained model; seed {}", seed),
      .mean = {0.0F, 0.0F, 0.4F},
      .scale = 0.15F,
      .trained = false,
      .variant = variant,
  };

  double bound = 0;  // of the layer whose .weight came last: 1 / sqrt(in), or 0 in a LayerNorm
  std::uint64_t stream = 0;
  for (Expected& expected : manifest(variant)) {
    Tensor tensor{expected.name, expected.shape, {}};
    tensor.values.resize(count_of(tensor.shape));
    const bool matrix = tensor.shape.size() == 2;
    if (tensor.name == "node") {
      fill_gaussian(tensor.values, kNodeDeviation, seed, stream);
    } else if (tensor.name == "gamma" || (ends_with(tensor.name, ".weight") && !matrix)) {
      tensor.values.assign(tensor.values.size(), 1.0F);
      bound = 0;
    } else {
      if (matrix) bound = 1.0 / std::sqrt(static_cast<double>(tensor.shape[1]));
      if (bound > 0) fill_uniform(tensor.values, bound, seed, stream);
    }
    weights.tensors.push_back(std::move(tensor));
    ++stream;
  }
  return weights;
}

}  // namespace flowdlo::weights
