// Kernels: the dense operations on one block of rows, once for each instruction set.
//
// linear.cpp, narrow.cpp, layer_norm.cpp, attention.cpp and convolution.cpp are compiled several
// times, each time into the namespace named by FLOWDLO_ISA, so that the linker cannot mix code of
// two instruction sets. They take plain pointers and use no library for the same reason.
#pragma once

#include <cstddef>
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

/// One block of an image; see ops::Convolution.
struct ConvolutionBlock {
  const float* x;       ///< the whole tensor
  const float* around;  ///< [9] of the map: the blocks around this one
  const float* panels;  ///< the weight [out, taps * in] as pack() lays it out
  const float* bias;    ///< [out]
  float* y;             ///< the block's first row
  int side;
  int taps;
  int in;
  int out;
  bool relu;
};

/// Floats of a block and the places around it, at most.
inline constexpr int kMostAround = 16384;

/// The entries of one instruction set.
struct Kernels {
  const char* isa;
  /// Lays a weight [out, in] out for `linear` and `convolution`, in as many panels as hold `out`
  /// columns.
  void (*pack)(const float* weight, int out, int in, float* panels);
  void (*linear)(const LinearBlock&);
  void (*narrow)(const NarrowBlock&);
  void (*layer_norm)(const LayerNormBlock&);
  void (*attention)(const AttentionBlock&);
  void (*convolution)(const ConvolutionBlock&);
};

/// All that both this build and this processor have, the widest first.
[[nodiscard]] std::span<const Kernels> kernels_of_this_cpu();

}  // namespace flowdlo::reference
