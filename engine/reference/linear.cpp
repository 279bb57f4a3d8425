// Twin of shaders/gemm: y = act(x W^T + b) + residual.
#include <Eigen/Core>
#include <algorithm>

#include "reference/gelu.hpp"
#include "reference/isa.hpp"

namespace flowdlo::reference::FLOWDLO_ISA {
namespace {

using Matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using ConstStrided = Eigen::Map<const Matrix, 0, Eigen::OuterStride<>>;

ConstStrided residual(const LinearBlock& block) {
  return {block.residual + block.column, block.rows, block.columns,
          Eigen::OuterStride<>(block.out)};
}

}  // namespace

void linear(const LinearBlock& block) {
  using Strided = Eigen::Map<Matrix, 0, Eigen::OuterStride<>>;

  const Eigen::Map<const Matrix> x(block.x, block.rows, block.in);
  const Eigen::Map<const Matrix> weight(
      block.weight + static_cast<std::ptrdiff_t>(block.column) * block.in, block.columns, block.in);
  const Eigen::Map<const Eigen::RowVectorXf> bias(block.bias + block.column, block.columns);
  Strided y(block.y + block.column, block.rows, block.columns, Eigen::OuterStride<>(block.out));

  // Without an activation the sum starts from the residual; with one the residual has to wait, and
  // since it may be y itself, in a copy.
  const bool gelu = block.activation == ops::Activation::kGelu;
  Matrix added_last;
  if (block.residual != nullptr && gelu) added_last = residual(block);
  if (block.residual != nullptr && !gelu) {
    y = residual(block).rowwise() + bias;
  } else {
    y.rowwise() = bias;
  }
  y.noalias() += x * weight.transpose();
  if (!gelu) return;
  auto values = y.array();
  gelu_in_place(values);
  if (added_last.size() > 0) y += added_last;
}

}  // namespace flowdlo::reference::FLOWDLO_ISA
