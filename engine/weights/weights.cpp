#include "weights/weights.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "weights/metadata.hpp"
#include "weights/stored_tensor.hpp"

namespace flowdlo::weights {

const Tensor& named(std::span<const Tensor> tensors, std::string_view name) {
  const auto found = std::find_if(tensors.begin(), tensors.end(),
                                  [name](const Tensor& tensor) { return tensor.name == name; });
  assert(found != tensors.end());
  return *found;
}

const Tensor& Weights::at(std::string_view name) const { return named(tensors, name); }

std::vector<std::string> faults(const Weights& weights) {
  auto list = faults(weights.metadata);
  const Variant variant = usable(weights.metadata.variant);
  std::vector<StoredTensor> stored;
  for (const Tensor& tensor : weights.tensors) {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(tensor.values.data());
    stored.push_back({tensor.name,
                      {tensor.shape.begin(), tensor.shape.end()},
                      DType::kF32,
                      "f32",
                      {bytes, tensor.values.size() * sizeof(float)}});
  }
  constexpr std::array kInMemory{DType::kF32};
  const auto matched = match(stored, manifest(variant), kInMemory, list);
  if (list.empty()) {
    for (std::size_t i = 0; i < stored.size(); ++i) {
      if (matched[i] == &stored[i]) continue;
      list.push_back(fmt::format("tensors: expected the manifest's order, got {} at {}",
                                 in_quotes(stored[i].name), i));
    }
  }
  for (const Tensor& tensor : weights.tensors) {
    auto fault = finiteness_fault(tensor.name, tensor.values);
    if (!fault.empty()) list.push_back(std::move(fault));
  }
  return list;
}

}  // namespace flowdlo::weights
