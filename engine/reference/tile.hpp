// Tile: the inner loop of every product. A few rows times two registers of columns stay in
// registers while the depth goes by.
#pragma once

#include "reference/lanes.hpp"

#if defined(__aarch64__)
#include <arm_neon.h>
#endif

namespace flowdlo::reference::FLOWDLO_ISA {

// As many sums as the registers hold beside one row of the panel and one broadcast value.
#if defined(__AVX512F__)
constexpr int kTileRows = 12;
#elif defined(__AVX__)
constexpr int kTileRows = 6;
#elif defined(__aarch64__)
constexpr int kTileRows = 8;
#else
constexpr int kTileRows = 4;
#endif
constexpr int kTileLanes = 2;
constexpr int kPanel = kTileLanes * kLanes;  ///< columns of a tile

/// `kAcross` registers of columns: fewer than kTileLanes where a panel is not full.
template <int kRows, int kAcross = kTileLanes>
struct Tile {
  Lanes sums[kRows][kAcross];
};

#if defined(__aarch64__)
// A multiply-add takes its scalar from any lane of a register, so that scalars which are neighbours
// come four by one load: 16 sums, 8 registers of scalars and a row of the panel are 26 registers.

constexpr int kScalars = 4;  ///< of a register

/// Loaded as a register of scalars: by way of memcpy, GCC 12 takes it apart in general registers.
FLOWDLO_INLINE Lanes load_scalars(const float* from) { return vld1q_f32(from); }

/// As accumulate(), for rows whose depths are neighbours. Returns how many depths it has taken, all
/// but a remainder below 4.
template <int kRows, int kAcross>
FLOWDLO_INLINE int accumulate_by_rows(Tile<kRows, kAcross>& tile, const float* x,
                                      std::ptrdiff_t row_step, const float* panel,
                                      std::ptrdiff_t panel_step, int depth) {
  int k = 0;
#pragma GCC unroll 1
  for (; k + kScalars <= depth; k += kScalars) {
    Lanes scalars[kRows];
#pragma GCC unroll 16
    for (int r = 0; r < kRows; ++r) scalars[r] = load_scalars(x + r * row_step + k);
#pragma GCC unroll 4
    for (int j = 0; j < kScalars; ++j) {
      Lanes columns[kAcross];
      for (int i = 0; i < kAcross; ++i) {
        columns[i] = load(panel + (k + j) * panel_step + i * kLanes);
      }
#pragma GCC unroll 16
      for (int r = 0; r < kRows; ++r) {
        for (int i = 0; i < kAcross; ++i) tile.sums[r][i] += columns[i] * scalars[r][j];
      }
    }
  }
  return k;
}

/// As accumulate(), for depths whose rows are neighbours; kRows is a multiple of 4.
template <int kRows, int kAcross>
FLOWDLO_INLINE void accumulate_by_depths(Tile<kRows, kAcross>& tile, const float* x,
                                         std::ptrdiff_t depth_step, const float* panel,
                                         std::ptrdiff_t panel_step, int depth) {
#pragma GCC unroll 2
  for (int k = 0; k < depth; ++k) {
    Lanes columns[kAcross];
    for (int i = 0; i < kAcross; ++i) columns[i] = load(panel + k * panel_step + i * kLanes);
#pragma GCC unroll 4
    for (int first = 0; first < kRows; first += kScalars) {
      const Lanes scalars = load_scalars(x + k * depth_step + first);
#pragma GCC unroll 4
      for (int r = 0; r < kScalars; ++r) {
        for (int i = 0; i < kAcross; ++i) {
          tile.sums[first + r][i] += columns[i] * scalars[r];
        }
      }
    }
  }
}
#endif

/// sums[r] += sum over k of x[r * row_step + k * depth_step] * panel[k * panel_step ...].
template <int kRows, int kAcross>
FLOWDLO_INLINE void accumulate(Tile<kRows, kAcross>& tile, const float* x, std::ptrdiff_t row_step,
                               std::ptrdiff_t depth_step, const float* panel,
                               std::ptrdiff_t panel_step, int depth) {
  int k = 0;
#if defined(__aarch64__)
  if (depth_step == 1) {
    k = accumulate_by_rows(tile, x, row_step, panel, panel_step, depth);
  } else if constexpr (kRows % kScalars == 0) {
    if (row_step == 1) return accumulate_by_depths(tile, x, depth_step, panel, panel_step, depth);
  }
#endif
#pragma GCC unroll 2  // more spills the sums of AVX2
  for (; k < depth; ++k) {
    Lanes columns[kAcross];
    for (int i = 0; i < kAcross; ++i) columns[i] = load(panel + k * panel_step + i * kLanes);
#pragma GCC unroll 16
    for (int r = 0; r < kRows; ++r) {
      const float value = x[r * row_step + k * depth_step];
      for (int i = 0; i < kAcross; ++i) tile.sums[r][i] += value * columns[i];
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
