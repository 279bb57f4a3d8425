// Convolutions of 3 x 3 taps, as products of 36 small matrices (Winograd's F(4 x 4, 3 x 3)).
//
// A square of 4 x 4 places of the result depends on 6 x 6 places of the input. Both, and the taps,
// are turned into polynomials' values at six points each way, 0, 1, -1, 2, -2 and infinity, where a
// convolution is a product value by value: 36 products of channels by channels instead of 144, and
// turning there and back costs sums alone. See Lavin and Gray, Fast Algorithms for Convolutional
// Neural Networks, 2016.
#include "reference/isa.hpp"
#include "reference/tile.hpp"

namespace flowdlo::reference::FLOWDLO_ISA {
namespace {

constexpr int kAround = 6;  // places each way that a tile reads
constexpr int kOwn = 4;     // of the nine blocks around
// Floats between one point's values and the next one's: constants, so that the 36 addresses of a
// place are one and an offset, and a cache line more than the values take, so that they do not
// share a few sets of the nearest cache.
constexpr int kLine = 16;
constexpr int kTurnedApart = kMostTileInputs + kLine;
constexpr int kProductsApart = kMostTiles * kPanel + kLine;

FLOWDLO_INLINE std::ptrdiff_t floats(int rows, int columns) {
  return static_cast<std::ptrdiff_t>(rows) * columns;
}

/// Six places in a row as values at the six points.
FLOWDLO_INLINE void to_points(const Lanes (&d)[kAround], Lanes (&to)[kAround]) {
  const Lanes even = d[4] - 4.0F * d[2];
  const Lanes odd = d[3] - 4.0F * d[1];
  const Lanes wide_even = d[4] - d[2];
  const Lanes wide_odd = 2.0F * (d[3] - d[1]);
  to[0] = 4.0F * d[0] - 5.0F * d[2] + d[4];
  to[1] = even + odd;
  to[2] = even - odd;
  to[3] = wide_even + wide_odd;
  to[4] = wide_even - wide_odd;
  to[5] = 4.0F * d[1] - 5.0F * d[3] + d[5];
}

/// Four places of the result from values at the six points.
FLOWDLO_INLINE void from_points(const Lanes (&m)[kAround], Lanes (&to)[kTileSide]) {
  const Lanes sum = m[1] + m[2];
  const Lanes difference = m[1] - m[2];
  const Lanes wide_sum = m[3] + m[4];
  const Lanes wide_difference = m[3] - m[4];
  to[0] = m[0] + sum + wide_sum;
  to[1] = difference + 2.0F * wide_difference;
  to[2] = sum + 4.0F * wide_sum;
  to[3] = difference + 8.0F * wide_difference + m[5];
}

/// The 6 x 6 places that the tile at (v, u) of a block reads, as pointers to their channels.
struct Places {
  const float* at[kAround][kAround];

  FLOWDLO_INLINE Places(const SquareBlocks& blocks, const float* around, const float* zeros, int v,
                        int u) {
    const int side = blocks.side;
    for (int i = 0; i < kAround; ++i) {
      const int below = v + i - 1;
      const int down = below < 0 ? 0 : below < side ? 1 : 2;
      const int row = (below + side) % side;
      for (int j = 0; j < kAround; ++j) {
        const int beside = u + j - 1;
        const int across = beside < 0 ? 0 : beside < side ? 1 : 2;
        const auto block = static_cast<int>(around[3 * down + across]);
        const int column = (beside + side) % side;
        at[i][j] =
            block < 0 ? zeros : blocks.x + floats((block * side + row) * side + column, blocks.in);
      }
    }
  }
};

/// One tile's channels at each point, kTurnedApart floats from one to the next.
FLOWDLO_INLINE void turn_input(const Places& places, int in, float* to) {
  for (int channel = 0; channel < in; channel += kLanes) {
    Lanes rows[kAround][kAround];
    for (int j = 0; j < kAround; ++j) {
      Lanes column[kAround];
      Lanes turned[kAround];
      for (int i = 0; i < kAround; ++i) column[i] = load(places.at[i][j] + channel);
      to_points(column, turned);
      for (int i = 0; i < kAround; ++i) rows[i][j] = turned[i];
    }
    for (int i = 0; i < kAround; ++i) {
      Lanes turned[kAround];
      to_points(rows[i], turned);
      for (int j = 0; j < kAround; ++j) {
        store(to + (i * kAround + j) * kTurnedApart + channel, turned[j]);
      }
    }
  }
}

/// y of one tile, `count` registers of channels, from its products at each point.
FLOWDLO_INLINE void turn_result(const SquareBlocks& blocks, const float* products, int column,
                                int count, float* y) {
  for (int lanes = 0; lanes < count; ++lanes) {
    const int first = column + lanes * kLanes;
    const Lanes bias = load(blocks.bias + first);
    Lanes columns[kTileSide][kAround];
    for (int j = 0; j < kAround; ++j) {
      Lanes values[kAround];
      Lanes turned[kTileSide];
      for (int i = 0; i < kAround; ++i) {
        values[i] = load(products + (i * kAround + j) * kProductsApart + lanes * kLanes);
      }
      from_points(values, turned);
      for (int i = 0; i < kTileSide; ++i) columns[i][j] = turned[i];
    }
    for (int i = 0; i < kTileSide; ++i) {
      Lanes turned[kTileSide];
      from_points(columns[i], turned);
      for (int j = 0; j < kTileSide; ++j) {
        const Lanes sum = turned[j] + bias;
        store(y + floats(i * blocks.side + j, blocks.out) + first,
              blocks.relu ? larger(sum, Lanes{}) : sum);
      }
    }
  }
}

/// products[tiles][kPanel] = x[tiles][in] times `kAcross` registers of columns of one panel of one
/// point's matrix.
template <int kRows, int kAcross>
FLOWDLO_INLINE void multiply(const float* x, int in, const float* panel, float* products) {
  Tile<kRows, kAcross> tile{};
  accumulate(tile, x, in, 1, panel, kPanel, in);
  for (int r = 0; r < kRows; ++r) {
    for (int i = 0; i < kAcross; ++i) {
      store(products + floats(r, kPanel) + i * kLanes, tile.sums[r][i]);
    }
  }
}

template <int kAcross>
FLOWDLO_INLINE void multiply_all(const float* x, int tiles, int in, const float* panel,
                                 float* products) {
  constexpr int kMost = kTileRows >= 8 ? 8 : kTileRows;
  int row = 0;
  for (; row + kMost <= tiles; row += kMost) {
    multiply<kMost, kAcross>(x + floats(row, in), in, panel, products + floats(row, kPanel));
  }
  for (; row + 4 <= tiles; row += 4) {
    multiply<4, kAcross>(x + floats(row, in), in, panel, products + floats(row, kPanel));
  }
  for (; row + 2 <= tiles; row += 2) {
    multiply<2, kAcross>(x + floats(row, in), in, panel, products + floats(row, kPanel));
  }
  for (; row < tiles; ++row) {
    multiply<1, kAcross>(x + floats(row, in), in, panel, products + floats(row, kPanel));
  }
}

}  // namespace

void square_convolution(const SquareBlocks& blocks) {
  // NOLINTBEGIN: a library's array is not of one instruction set
  alignas(64) float turned[kTurned * kTurnedApart];
  alignas(64) float products[kTurned * kProductsApart];
  alignas(64) float zeros[kMostTileInputs];
  // NOLINTEND
  __builtin_memset(zeros, 0, static_cast<std::size_t>(blocks.in) * sizeof(float));
  const int side = blocks.side;
  const int across = side / kTileSide;
  const int tiles = blocks.blocks * across * across;
  const auto map_of = [&](int tile) {
    return blocks.map + floats(tile / (across * across), blocks.map_columns);
  };
  const auto row_of = [&](int tile) { return tile / across % across * kTileSide; };
  const auto column_of = [&](int tile) { return tile % across * kTileSide; };
  for (int tile = 0; tile < tiles; ++tile) {
    turn_input(Places(blocks, map_of(tile), zeros, row_of(tile), column_of(tile)), blocks.in,
               turned + floats(tile, blocks.in));
  }
  for (int column = 0; column < blocks.out; column += kPanel) {
    const int left = (blocks.out - column) / kLanes;
    for (int point = 0; point < kTurned; ++point) {
      const float* const x = turned + floats(point, kTurnedApart);
      const float* const panel =
          blocks.panels + floats(point, blocks.in) * blocks.columns + floats(column, blocks.in);
      float* const to = products + floats(point, kProductsApart);
      if (left < kTileLanes) {
        multiply_all<1>(x, tiles, blocks.in, panel, to);
      } else {
        multiply_all<kTileLanes>(x, tiles, blocks.in, panel, to);
      }
    }
    for (int tile = 0; tile < tiles; ++tile) {
      const auto block = static_cast<std::ptrdiff_t>(map_of(tile)[kOwn]);
      const std::ptrdiff_t place = (block * side + row_of(tile)) * side + column_of(tile);
      turn_result(blocks, products + floats(tile, kPanel), column,
                  left < kTileLanes ? left : kTileLanes, blocks.y + place * blocks.out);
    }
  }
}

}  // namespace flowdlo::reference::FLOWDLO_ISA
