// Tile: the inner loop of every product. A few rows times two registers of columns stay in
// registers while the depth goes by.
#pragma once

#include "reference/lanes.hpp"

namespace flowdlo::reference::FLOWDLO_ISA {

// As many sums as the registers hold beside one row of the panel and one broadcast value.
#if defined(__AVX512F__)
constexpr int kTileRows = 12;
#elif defined(__AVX__)
constexpr int kTileRows = 6;
#else
constexpr int kTileRows = 4;
#endif
constexpr int kTileLanes = 2;
constexpr int kPanel = kTileLanes * kLanes;  ///< columns of a tile

template <int kRows>
struct Tile {
  Lanes sums[kRows][kTileLanes];
};

/// sums[r] += sum over k of x[r * row_step + k * depth_step] * panel[k * panel_step ...].
template <int kRows>
FLOWDLO_INLINE void accumulate(Tile<kRows>& tile, const float* x, std::ptrdiff_t row_step,
                               std::ptrdiff_t depth_step, const float* panel,
                               std::ptrdiff_t panel_step, int depth) {
#pragma GCC unroll 2  // more spills the sums of AVX2
  for (int k = 0; k < depth; ++k) {
    Lanes columns[kTileLanes];
    for (int i = 0; i < kTileLanes; ++i) columns[i] = load(panel + k * panel_step + i * kLanes);
#pragma GCC unroll 16
    for (int r = 0; r < kRows; ++r) {
      const float value = x[r * row_step + k * depth_step];
      for (int i = 0; i < kTileLanes; ++i) tile.sums[r][i] += value * columns[i];
    }
  }
}

template <int kRows>
struct RowCount {
  static constexpr int value = kRows;
};

/// work(first row, RowCount) for tiles of kTileRows, and for smaller ones at the end. `rows` is
/// even.
template <class Work>
FLOWDLO_INLINE void for_tiles(int rows, const Work& work) {
  int row = 0;
  for (; row + kTileRows <= rows; row += kTileRows) work(row, RowCount<kTileRows>{});
  if (row + 8 <= rows && kTileRows > 8) {
    work(row, RowCount<8>{});
    row += 8;
  }
  for (; row + 4 <= rows; row += 4) work(row, RowCount<4>{});
  for (; row + 2 <= rows; row += 2) work(row, RowCount<2>{});
}

}  // namespace flowdlo::reference::FLOWDLO_ISA
