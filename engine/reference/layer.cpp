#include "reference/layer.hpp"

#include <algorithm>
#include <cstddef>

#include "weights/half.hpp"

namespace flowdlo::reference {
namespace {

constexpr int kMostNarrow = 8;  // inputs of a layer that ops::Narrow takes

AlignedFloats columns_of(std::span<const float> weight, std::size_t out, std::size_t in) {
  AlignedFloats columns(weight.size());
  for (std::size_t column = 0; column < out; ++column) {
    for (std::size_t i = 0; i < in; ++i) {
      columns.data()[i * out + column] = weight[column * in + i];
    }
  }
  return columns;
}

AlignedHalves exact_halves(std::span<const float> values) {
  AlignedHalves halves(values.size());
  std::transform(values.begin(), values.end(), halves.data(), weights::exact_half);
  return halves;
}

}  // namespace

Layer linear_layer(const Kernels& kernels, int out, int in, std::span<const float> weight,
                   std::span<const float> bias) {
  Layer layer{AlignedFloats{}, AlignedFloats(bias.size())};
  std::copy(bias.begin(), bias.end(), layer.bias.data());
  if (in <= kMostNarrow) {
    layer.weight = columns_of(weight, static_cast<std::size_t>(out), static_cast<std::size_t>(in));
    return layer;
  }
  layer.weight = AlignedFloats(weight.size());
  if (out % kPartColumns != 0) {
    std::copy(weight.begin(), weight.end(), layer.weight.data());
    return layer;
  }
  kernels.pack(weight.data(), out, in, layer.weight.data());
  if (kernels.widens_halves && std::all_of(weight.begin(), weight.end(), weights::is_half)) {
    layer.halves = exact_halves(layer.weight.span());
    layer.weight = {};
  }
  return layer;
}

}  // namespace flowdlo::reference
