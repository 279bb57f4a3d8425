#include "weights/refine_weights.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

#include "random/philox.hpp"

namespace flowdlo::weights {
namespace {

constexpr std::string_view kPrefix = "refine.";

}  // namespace

const Tensor& RefineWeights::at(std::string_view wanted) const {
  const auto found = std::find_if(tensors.begin(), tensors.end(), [wanted](const Tensor& tensor) {
    return std::string_view(tensor.name).substr(kPrefix.size()) == wanted;
  });
  assert(found != tensors.end());
  return *found;
}

std::vector<Expected> refine_manifest() {
  std::vector<Expected> expected;
  const auto add = [&](const std::string& name, int out, int taps, int in) {
    expected.push_back({fmt::format("{}{}.weight", kPrefix, name), {out, taps, in}});
    expected.push_back({fmt::format("{}{}.bias", kPrefix, name), {out}});
  };
  add("stem", kRefineStem, 1, kRefineInputs);
  for (int i = 0; i < kRefineSquares; ++i) {
    add(fmt::format("square.{}", i), kRefineWidth, 9, i == 0 ? kRefineStem : kRefineWidth);
  }
  add("head", kRefineOutputs, 1, kRefineWidth);
  return expected;
}

RefineWeights seeded_refine(std::uint64_t seed) {
  RefineWeights weights;
  std::uint64_t stream = 0;
  for (Expected& expected : refine_manifest()) {
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
    weights.tensors.push_back(std::move(tensor));
  }
  return weights;
}

}  // namespace flowdlo::weights
