// Convolutions of one block: its places and those around it are gathered once, so that the inputs
// of a row of taps lie side by side, and every sum is a product of the kind that linear.cpp makes.
#include "reference/isa.hpp"
#include "reference/tile.hpp"

namespace flowdlo::reference::FLOWDLO_ISA {
namespace {

constexpr int kOwn = 4;  // of the nine blocks around

FLOWDLO_INLINE std::ptrdiff_t floats(int rows, int columns) {
  return static_cast<std::ptrdiff_t>(rows) * columns;
}

FLOWDLO_INLINE void copy(const float* from, std::ptrdiff_t count, float* to) {
  __builtin_memcpy(to, from, static_cast<std::size_t>(count) * sizeof(float));
}

FLOWDLO_INLINE void clear(std::ptrdiff_t count, float* to) {
  __builtin_memset(to, 0, static_cast<std::size_t>(count) * sizeof(float));
}

/// [side + 2, side + 2, in]: the block with a place around it.
void gather(const ConvolutionBlock& block, float* to) {
  const int side = block.side;
  for (int v = -1; v <= side; ++v) {
    const int down = v < 0 ? 0 : v < side ? 1 : 2;
    const int row = v < 0 ? side - 1 : v < side ? v : 0;
    for (int across = 0; across < 3; ++across) {
      const int count = across == 1 ? side : 1;
      const int column = across == 0 ? side - 1 : 0;
      const auto other = static_cast<int>(block.around[3 * down + across]);
      if (other < 0) {
        clear(floats(count, block.in), to);
      } else {
        copy(block.x + floats((other * side + row) * side + column, block.in),
             floats(count, block.in), to);
      }
      to += floats(count, block.in);
    }
  }
}

/// kRows places that lie side by side, one panel of channels.
template <int kRows>
FLOWDLO_INLINE void convolve(const ConvolutionBlock& block, const float* x, std::ptrdiff_t line,
                             int lines, int depth, const float* panel, int column, float* y) {
  Tile<kRows> tile;
  for (int i = 0; i < kTileLanes; ++i) {
    const int first = column + i * kLanes;
    const Lanes bias = first < block.out ? load(block.bias + first) : Lanes{};
    for (int r = 0; r < kRows; ++r) tile.sums[r][i] = bias;
  }
  for (int k = 0; k < lines; ++k) {
    accumulate(tile, x + k * line, block.in, 1, panel + floats(k * depth, kPanel), kPanel, depth);
  }
  for (int r = 0; r < kRows; ++r) {
    for (int i = 0; i < kTileLanes; ++i) {
      const int first = column + i * kLanes;
      if (first >= block.out) continue;
      const Lanes sum = tile.sums[r][i];
      store(y + floats(r, block.out) + first, block.relu ? larger(sum, Lanes{}) : sum);
    }
  }
}

/// A row of places. Eight or four at a time: as many as the registers hold, and sides are
/// multiples of them.
FLOWDLO_INLINE void convolve_row(const ConvolutionBlock& block, const float* x, std::ptrdiff_t line,
                                 int lines, int depth, const float* panel, int column, float* y) {
  constexpr int kMost = kTileRows >= 8 ? 8 : 4;
  int at = 0;
  for (; at + kMost <= block.side; at += kMost) {
    convolve<kMost>(block, x + floats(at, block.in), line, lines, depth, panel, column,
                    y + floats(at, block.out));
  }
  for (; at + 4 <= block.side; at += 4) {
    convolve<4>(block, x + floats(at, block.in), line, lines, depth, panel, column,
                y + floats(at, block.out));
  }
}

}  // namespace

void convolution(const ConvolutionBlock& block) {
  alignas(64) float memory[kMostAround];  // NOLINT: a library's array is not of one instruction set
  const int side = block.side;
  const bool square = block.taps == 9;
  const auto own = static_cast<int>(block.around[kOwn]);
  const float* x = block.x + floats(own * side * side, block.in);
  if (square) {
    gather(block, memory);
    x = memory;
  }
  const int width = square ? side + 2 : side;  // places from one row to the next
  const int lines = square ? 3 : 1;
  const int depth = lines * block.in;
  for (int column = 0; column < block.out; column += kPanel) {
    const float* const panel = block.panels + floats(column, block.taps * block.in);
    for (int row = 0; row < side; ++row) {
      convolve_row(block, x + floats(row * width, block.in), floats(width, block.in), lines, depth,
                   panel, column, block.y + floats(row * side, block.out));
    }
  }
}

}  // namespace flowdlo::reference::FLOWDLO_ISA
