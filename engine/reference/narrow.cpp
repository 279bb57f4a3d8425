// Twin of shaders/narrow, without its addends: y = act(x W^T + b) for x of at most eight columns.
#include <Eigen/Core>
#include <algorithm>

#include "reference/gelu.hpp"
#include "reference/isa.hpp"

namespace flowdlo::reference::FLOWDLO_ISA {

void narrow(const NarrowBlock& block) {
  using Matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::Map<const Matrix> weight(block.weight, block.out, block.in);
  const Eigen::Map<const Eigen::RowVectorXf> bias(block.bias, block.out);
  const Eigen::Map<const Matrix, 0, Eigen::OuterStride<>> x(block.x, block.rows, block.in,
                                                            Eigen::OuterStride<>(block.x_columns));
  Eigen::Map<Matrix> y(block.y, block.rows, block.out);
  y = x.lazyProduct(weight.transpose()).rowwise() + bias;
  if (block.activation == ops::Activation::kGelu) {
    auto values = y.array();
    gelu_in_place(values);
  }
}

}  // namespace flowdlo::reference::FLOWDLO_ISA
