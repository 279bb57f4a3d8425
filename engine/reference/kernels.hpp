// Kernels: the dense operations on one block of rows, once for each instruction set.
//
// linear.cpp, narrow.cpp, layer_norm.cpp, attention.cpp, point_convolution.cpp and
// square_convolution.cpp are compiled several times, each time into the namespace named by
// FLOWDLO_ISA, so that the linker cannot mix code of two instruction sets. They take plain pointers
// and use no library for the same reason.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "ops/program.hpp"

namespace flowdlo::reference {

/// y[0:rows, :] = act(x W^T + b) + residual for columns [column, column + columns) of y.
struct LinearBlock {
  const float* x;         ///< [rows, in]
  const float* panels;    ///< the weight as pack() lays it out
  const float* bias;      ///< [out]
  const float* residual;  ///< [rows, out], or null; may be y
  float* y;               ///< [rows, out]
  int rows;
  int in;
  int out;
  int column;
  int columns;
  ops::Activation activation;
  /// The panels as IEEE 754 binary16, in place of `panels`; for kernels that widen them.
  const std::uint16_t* half_panels = nullptr;
};

/// Rows of a table: row r of the whole tensor takes table[r % period + offset]; see ops::Addend.
struct AddendBlock {
  const float* table = nullptr;  ///< null: nothing is added
  int period = 1;
  int offset = 0;
};

/// y = act(x W^T + b) + first + second; see ops::Narrow.
struct NarrowBlock {
  const float* x;        ///< [rows, x_columns]
  const float* columns;  ///< [in, out], the weight's columns
  const float* bias;
  float* y;  ///< [rows, out]
  AddendBlock first;
  AddendBlock second;
  int row;  ///< of the whole tensor; the block's first
  int rows;
  int x_columns;
  int in;
  int out;
  ops::Activation activation;
};

struct LayerNormBlock {
  const float* x;      ///< [rows, 256]
  const float* gain;   ///< [256]
  const float* shift;  ///< [256]
  float* y;            ///< [rows, 256]
  int rows;
};

/// One head of one draw: 64 queries against `keys` keys.
struct AttentionBlock {
  const float* query;  ///< first query's channel 0 of this head
  const float* key;
  const float* value;
  const float* key_valid;  ///< [keys, 4], column 3 above 0.5 is valid; null: all are
  float* out;              ///< first row's channel 0 of this head
  int query_stride;        ///< floats from one row to the next
  int key_value_stride;
  int out_stride;
  int keys;  ///< at most kMaxKeys
};

inline constexpr int kMaxKeys = 256;

/// Places of an image, each for itself; see ops::Convolution with one tap.
struct PointRows {
  const float* x;       ///< [rows, in]
  const float* panels;  ///< the weight [out, in] as pack() lays it out
  const float* bias;    ///< [out]
  float* y;             ///< [rows, out]
  int rows;             ///< even
  int in;
  int out;
  bool relu;
};

inline constexpr int kMostPanel = 64;  ///< columns of a panel of any instruction set, at most

inline constexpr int kTurned = 36;     ///< matrices that stand for a weight of 3 x 3 taps
inline constexpr int kTileSide = 4;    ///< places of a result that are made together, each way
inline constexpr int kMostTiles = 16;  ///< of one call, and so many times their inputs
inline constexpr int kMostTileInputs = 768;

/// Consecutive blocks of an image, all in use; see ops::Convolution with nine taps. Their tiles are
/// at most kMostTiles, times `in` at most kMostTileInputs.
struct SquareBlocks {
  const float* x;    ///< the whole tensor
  const float* map;  ///< the first block's row
  int map_columns;
  int blocks;
  const float* panels;  ///< kTurned matrices, each [out, in] as pack() lays it out, `columns` wide
  const float* bias;    ///< [out]
  float* y;             ///< the whole tensor
  int side;
  int in;
  int out;
  int columns;
  bool relu;
};

/// The entries of one instruction set.
struct Kernels {
  const char* isa;
  bool widens_halves;  ///< `linear` takes LinearBlock::half_panels
  /// Lays a weight [out, in] out for `linear` and convolutions, in as many panels as hold `out`
  /// columns.
  void (*pack)(const float* weight, int out, int in, float* panels);
  void (*linear)(const LinearBlock&);
  void (*narrow)(const NarrowBlock&);
  void (*layer_norm)(const LayerNormBlock&);
  void (*attention)(const AttentionBlock&);
  void (*point_convolution)(const PointRows&);
  void (*square_convolution)(const SquareBlocks&);
};

/// All that both this build and this processor have, the widest first.
[[nodiscard]] std::span<const Kernels> kernels_of_this_cpu();

}  // namespace flowdlo::reference
