// Twin of shaders/layer_norm: y = (x - mean) / sqrt(var + 1e-5) * gain + shift, two-pass.
#include <Eigen/Core>
#include <cmath>

#include "reference/isa.hpp"

namespace flowdlo::reference::FLOWDLO_ISA {

void layer_norm(const LayerNormBlock& block) {
  using Row = Eigen::Array<float, 1, ops::kWidth>;
  const Eigen::Map<const Row> gain(block.gain);
  const Eigen::Map<const Row> shift(block.shift);
  for (int row = 0; row < block.rows; ++row) {
    const Eigen::Map<const Row> x(block.x + static_cast<std::ptrdiff_t>(row) * ops::kWidth);
    Eigen::Map<Row> y(block.y + static_cast<std::ptrdiff_t>(row) * ops::kWidth);
    const Row centred = x - x.mean();
    const float variance = centred.square().mean();
    y = centred * (1.0F / std::sqrt(variance + ops::kLayerNormEpsilon)) * gain + shift;
  }
}

}  // namespace flowdlo::reference::FLOWDLO_ISA
