#include "weights/seeded_noise.hpp"

#include <cmath>
#include <cstddef>
#include <utility>

#include "random/philox.hpp"

namespace flowdlo::weights {

std::vector<Tensor> seeded_noise(std::vector<Expected> manifest, std::uint64_t seed) {
  std::vector<Tensor> tensors;
  std::uint64_t stream = 0;
  for (Expected& expected : manifest) {
    Tensor tensor{std::move(expected.name), std::move(expected.shape), {}};
    std::size_t count = 1;
    for (const int extent : tensor.shape) count *= static_cast<std::size_t>(extent);
    const bool bias = tensor.shape.size() == 1;
    const double inputs = bias ? 100 : tensor.shape[1] * tensor.shape[2];
    const auto deviation = static_cast<float>(std::sqrt(2 / inputs));
    for (std::size_t i = 0; i < count; ++i) {
      tensor.values.push_back(deviation * random::gaussian(seed, i / 4, stream)[i % 4]);
    }
    ++stream;
    tensors.push_back(std::move(tensor));
  }
  return tensors;
}

}  // namespace flowdlo::weights
