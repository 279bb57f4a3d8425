// Convolutions of one tap: each place's channels times a matrix, as linear.cpp has it.
#include "reference/isa.hpp"
#include "reference/tile.hpp"

namespace flowdlo::reference::FLOWDLO_ISA {
namespace {

FLOWDLO_INLINE std::ptrdiff_t floats(int rows, int columns) {
  return static_cast<std::ptrdiff_t>(rows) * columns;
}

/// kRows places, `kAcross` registers of channels.
template <int kRows, int kAcross>
FLOWDLO_INLINE void convolve(const PointRows& rows, int row, int column) {
  Tile<kRows, kAcross> tile;
  for (int i = 0; i < kAcross; ++i) {
    const Lanes bias = load(rows.bias + column + i * kLanes);
    for (int r = 0; r < kRows; ++r) tile.sums[r][i] = bias;
  }
  accumulate(tile, rows.x + floats(row, rows.in), rows.in, 1, rows.panels + floats(column, rows.in),
             kPanel, rows.in);
  float* const y = rows.y + floats(row, rows.out);
  for (int r = 0; r < kRows; ++r) {
    for (int i = 0; i < kAcross; ++i) {
      const Lanes sum = tile.sums[r][i];
      store(y + floats(r, rows.out) + column + i * kLanes, rows.relu ? larger(sum, Lanes{}) : sum);
    }
  }
}

}  // namespace

void point_convolution(const PointRows& rows) {
  for (int column = 0; column < rows.out; column += kPanel) {
    const bool full = rows.out - column >= kPanel;
    for_tiles(rows.rows, [&](int row, auto count) {
      constexpr int kRows = decltype(count)::value;
      full ? convolve<kRows, kTileLanes>(rows, row, column) : convolve<kRows, 1>(rows, row, column);
    });
  }
}

}  // namespace flowdlo::reference::FLOWDLO_ISA
