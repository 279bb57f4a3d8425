// Twin of shaders/narrow: y = act(x W^T + b) + first + second for x of at most eight columns.
#include "reference/gelu.hpp"
#include "reference/isa.hpp"

namespace flowdlo::reference::FLOWDLO_ISA {
namespace {

/// The addend's row for row `row` of the whole tensor, or null.
FLOWDLO_INLINE const float* row_of(const AddendBlock& addend, int row, int columns) {
  if (addend.table == nullptr) return nullptr;
  return addend.table + static_cast<std::ptrdiff_t>(row % addend.period + addend.offset) * columns;
}

}  // namespace

void narrow(const NarrowBlock& block) {
  for (int row = 0; row < block.rows; ++row) {
    const float* const x = block.x + static_cast<std::ptrdiff_t>(row) * block.x_columns;
    float* const y = block.y + static_cast<std::ptrdiff_t>(row) * block.out;
    const float* const first = row_of(block.first, block.row + row, block.out);
    const float* const second = row_of(block.second, block.row + row, block.out);
    for (int column = 0; column < block.out; column += kLanes) {
      Lanes result = load(block.bias + column);
      for (int i = 0; i < block.in; ++i) {
        result += x[i] * load(block.columns + static_cast<std::ptrdiff_t>(i) * block.out + column);
      }
      if (block.activation == ops::Activation::kGelu) result = gelu(result);
      if (first != nullptr) result += load(first + column);
      if (second != nullptr) result += load(second + column);
      store(y + column, result);
    }
  }
}

}  // namespace flowdlo::reference::FLOWDLO_ISA
