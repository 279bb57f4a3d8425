// Twin of shaders/layer_norm: y = (x - mean) / sqrt(var + 1e-5) * gain + shift, two-pass.
#include "reference/isa.hpp"
#include "reference/lanes.hpp"

namespace flowdlo::reference::FLOWDLO_ISA {
namespace {

constexpr int kChains = 4;  // independent sums

/// The mean of value(i) over a row's registers i.
template <class Value>
FLOWDLO_INLINE float mean_of(const Value& value) {
  Lanes sums[kChains] = {};
  for (int i = 0; i < ops::kWidth / kLanes; i += kChains) {
    for (int chain = 0; chain < kChains; ++chain) sums[chain] += value(i + chain);
  }
  return sum((sums[0] + sums[1]) + (sums[2] + sums[3])) / static_cast<float>(ops::kWidth);
}

}  // namespace

void layer_norm(const LayerNormBlock& block) {
  for (int row = 0; row < block.rows; ++row) {
    const float* const x = block.x + static_cast<std::ptrdiff_t>(row) * ops::kWidth;
    float* const y = block.y + static_cast<std::ptrdiff_t>(row) * ops::kWidth;
    const float mean = mean_of([&](int i) { return load(x + i * kLanes); });
    const float variance = mean_of([&](int i) {
      const Lanes centred = load(x + i * kLanes) - mean;
      return centred * centred;
    });
    const float scale = 1.0F / __builtin_sqrtf(variance + ops::kLayerNormEpsilon);
    for (int i = 0; i < ops::kWidth; i += kLanes) {
      store(y + i, (load(x + i) - mean) * scale * load(block.gain + i) + load(block.shift + i));
    }
  }
}

}  // namespace flowdlo::reference::FLOWDLO_ISA
