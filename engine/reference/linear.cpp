// Twin of shaders/gemm: y = act(x W^T + b) + residual.
#include <Eigen/Core>
#include <algorithm>

#include "reference/gelu.hpp"
#include "reference/isa.hpp"

namespace flowdlo::reference::FLOWDLO_ISA {

void linear(const LinearBlock& block) {
  using Matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  using Strided = Eigen::Map<Matrix, 0, Eigen::OuterStride<>>;
  using ConstStrided = Eigen::Map<const Matrix, 0, Eigen::OuterStride<>>;
  const Eigen::OuterStride<> out_stride(block.out);

  const Eigen::Map<const Matrix> x(block.x, block.rows, block.in);
  const Eigen::Map<const Matrix> weight(
      block.weight + static_cast<std::ptrdiff_t>(block.column) * block.in, block.columns, block.in);
  const Eigen::Map<const Eigen::RowVectorXf> bias(block.bias + block.column, block.columns);
  Strided y(block.y + block.column, block.rows, block.columns, out_stride);

  if (block.residual == nullptr) {
    y.rowwise() = bias;
  } else {
    const ConstStrided residual(block.residual + block.column, block.rows, block.columns,
                                out_stride);
    y = residual.rowwise() + bias;
  }
  y.noalias() += x * weight.transpose();
  if (block.activation == ops::Activation::kGelu) {
    auto values = y.array();
    gelu_in_place(values);
  }
}

}  // namespace flowdlo::reference::FLOWDLO_ISA
