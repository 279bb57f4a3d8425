// Twin of shaders/attention: softmax(q k^T / sqrt(32)) v, one head of one draw.
#include <Eigen/Core>
#include <cmath>

#include "reference/isa.hpp"

namespace flowdlo::reference::FLOWDLO_ISA {

void attention(const AttentionBlock& block) {
  using Matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  using ConstRows =
      Eigen::Map<const Eigen::Matrix<float, Eigen::Dynamic, ops::kHeadWidth, Eigen::RowMajor>, 0,
                 Eigen::OuterStride<>>;
  using Scores = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor,
                               ops::kRowsPerDraw, kMaxKeys>;
  const Eigen::OuterStride<> key_stride(block.key_value_stride);
  const ConstRows query(block.query, ops::kRowsPerDraw, ops::kHeadWidth,
                        Eigen::OuterStride<>(block.query_stride));
  const ConstRows key(block.key, block.keys, ops::kHeadWidth, key_stride);
  const ConstRows value(block.value, block.keys, ops::kHeadWidth, key_stride);
  Eigen::Map<Matrix, 0, Eigen::OuterStride<>> out(block.out, ops::kRowsPerDraw, ops::kHeadWidth,
                                                  Eigen::OuterStride<>(block.out_stride));

  Scores scores(ops::kRowsPerDraw, block.keys);
  scores.noalias() = query * key.transpose();
  scores *= 1.0F / std::sqrt(static_cast<float>(ops::kHeadWidth));

  Eigen::Array<float, 1, Eigen::Dynamic, Eigen::RowMajor, 1, kMaxKeys> weight(block.keys);
  weight.setOnes();
  if (block.key_valid != nullptr) {
    for (int key_row = 0; key_row < block.keys; ++key_row) {
      weight[key_row] = block.key_valid[4 * key_row + 3] > 0.5F ? 1.0F : 0.0F;
    }
  }
  if (!(weight > 0.0F).any()) {  // spec section 6: contributes zero
    out.setZero();
    return;
  }
  for (int row = 0; row < ops::kRowsPerDraw; ++row) {
    auto line = scores.row(row).array();
    const float peak = (weight > 0.0F).select(line, -3.0e38F).maxCoeff();
    line = weight * (line - peak).min(0.0F).exp();
    line *= 1.0F / line.sum();
  }
  out.noalias() = scores * value;
}

}  // namespace flowdlo::reference::FLOWDLO_ISA
