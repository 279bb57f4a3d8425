// Twin of shaders/gemm: y = act(x W^T + b) + residual.
//
// The weights lie in panels of kPanel columns, [panel][in][kPanel], read from end to end. A block
// of 256 inputs of a panel stays in the nearest cache while the rows go by.
#include "reference/gelu.hpp"
#include "reference/isa.hpp"
#include "reference/tile.hpp"

namespace flowdlo::reference::FLOWDLO_ISA {
namespace {

constexpr int kDepth = 256;  // inputs of a panel taken at once

enum class Last { kNo, kPlain, kGelu };

/// One tile of y over one block of inputs: sums start from bias and residual, or from y.
template <int kRows>
FLOWDLO_INLINE void multiply(const LinearBlock& block, const float* panel, int row, int column,
                             int depth_begin, Last last) {
  const auto at = [](int i, int stride) { return static_cast<std::ptrdiff_t>(i) * stride; };
  float* const y = block.y + at(row, block.out) + column;
  const bool residual_first =
      block.residual != nullptr && block.activation != ops::Activation::kGelu;
  Tile<kRows> tile;
  for (int r = 0; r < kRows; ++r) {
    for (int i = 0; i < kTileLanes; ++i) {
      const std::ptrdiff_t offset = at(r, block.out) + i * kLanes;
      if (depth_begin > 0) {
        tile.sums[r][i] = load(y + offset);
      } else {
        tile.sums[r][i] = load(block.bias + column + i * kLanes);
        if (residual_first) {
          tile.sums[r][i] += load(block.residual + at(row, block.out) + column + offset);
        }
      }
    }
  }
  accumulate(tile, block.x + at(row, block.in) + depth_begin, block.in, 1,
             panel + at(depth_begin, kPanel), kPanel, kDepth);
  for (int r = 0; r < kRows; ++r) {
    for (int i = 0; i < kTileLanes; ++i) {
      const std::ptrdiff_t offset = at(r, block.out) + i * kLanes;
      Lanes result = tile.sums[r][i];
      if (last == Last::kGelu) {
        result = gelu(result);
        if (block.residual != nullptr) {
          result += load(block.residual + at(row, block.out) + column + offset);
        }
      }
      store(y + offset, result);
    }
  }
}

}  // namespace

void linear(const LinearBlock& block) {
  const bool with_gelu = block.activation == ops::Activation::kGelu;
  for (int column = block.column; column < block.column + block.columns; column += kPanel) {
    const float* const panel = block.panels + static_cast<std::ptrdiff_t>(column) * block.in;
    for (int depth = 0; depth < block.in; depth += kDepth) {
      const bool final_depth = depth + kDepth == block.in;
      const Last last = !final_depth ? Last::kNo : with_gelu ? Last::kGelu : Last::kPlain;
      for_tiles(block.rows, [&](int row, auto rows) {
        multiply<decltype(rows)::value>(block, panel, row, column, depth, last);
      });
    }
  }
}

void pack(const float* weight, int out, int in, float* panels) {
  for (int column = 0; column < out; ++column) {
    float* const panel = panels + static_cast<std::ptrdiff_t>(column / kPanel * kPanel) * in;
    for (int k = 0; k < in; ++k) {
      panel[static_cast<std::ptrdiff_t>(k) * kPanel + column % kPanel] =
          weight[static_cast<std::ptrdiff_t>(column) * in + k];
    }
  }
}

}  // namespace flowdlo::reference::FLOWDLO_ISA
