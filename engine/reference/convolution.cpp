#include "reference/convolution.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <vector>

namespace flowdlo::reference {
namespace {

constexpr int kPoints = 6;  // each way
constexpr int kTaps = 3;    // likewise
static_assert(kPoints * kPoints == kTurned);

// Three taps as a polynomial's values at 0, 1, -1, 2, -2 and infinity, each over what Lagrange's
// interpolation divides by.
constexpr std::array<std::array<double, kTaps>, kPoints> kTurn{{{1.0 / 4, 0, 0},
                                                                {-1.0 / 6, -1.0 / 6, -1.0 / 6},
                                                                {-1.0 / 6, 1.0 / 6, -1.0 / 6},
                                                                {1.0 / 24, 1.0 / 12, 1.0 / 6},
                                                                {1.0 / 24, -1.0 / 12, 1.0 / 6},
                                                                {0, 0, 1}}};

// [kTurned, out, in] of weight [out, 9, in].
std::vector<float> turned(std::span<const float> weight, std::size_t out, std::size_t in) {
  std::vector<float> result(kTurned * out * in);
  std::vector<double> sums(in);
  for (std::size_t i = 0; i < kTurned; ++i) {
    const auto& down = kTurn[i / kPoints];
    const auto& across = kTurn[i % kPoints];
    for (std::size_t row = 0; row < out; ++row) {
      std::fill(sums.begin(), sums.end(), 0.0);
      for (std::size_t tap = 0; tap < kTaps * kTaps; ++tap) {
        const double factor = down[tap / kTaps] * across[tap % kTaps];
        const float* const taps = weight.data() + (row * kTaps * kTaps + tap) * in;
        for (std::size_t column = 0; column < in; ++column) {
          sums[column] += factor * static_cast<double>(taps[column]);
        }
      }
      std::transform(sums.begin(), sums.end(), result.data() + (i * out + row) * in,
                     [](double sum) { return static_cast<float>(sum); });
    }
  }
  return result;
}

// Columns of the panels of a weight with so many rows: whole ones of every instruction set.
int whole_panels(int out) { return (out + kMostPanel - 1) / kMostPanel * kMostPanel; }

std::ptrdiff_t floats(int rows, int columns) {
  return static_cast<std::ptrdiff_t>(rows) * static_cast<std::ptrdiff_t>(columns);
}

}  // namespace

AlignedFloats convolution_weight(const Kernels& kernels, int out, int taps, int in,
                                 std::span<const float> weight) {
  const std::ptrdiff_t panels = floats(whole_panels(out), in);
  if (taps == 1) {
    AlignedFloats result(static_cast<std::size_t>(panels));
    kernels.pack(weight.data(), out, in, result.data());
    return result;
  }
  AlignedFloats result(static_cast<std::size_t>(kTurned * panels));
  const auto matrices = turned(weight, static_cast<std::size_t>(out), static_cast<std::size_t>(in));
  for (int i = 0; i < kTurned; ++i) {
    kernels.pack(matrices.data() + i * floats(out, in), out, in, result.data() + i * panels);
  }
  return result;
}

int blocks_together(const ops::Convolution& op) {
  if (op.layer.taps == 1) return 1;
  const int tiles = op.side * op.side / (kTileSide * kTileSide);  // of a block
  assert(tiles * op.layer.in <= kMostTileInputs);
  return std::min(kMostTiles, kMostTileInputs / op.layer.in) / tiles;
}

void convolve(const Kernels& kernels, const ops::Convolution& op, const ConvolutionMemory& memory,
              int first, int blocks) {
  const int places = op.side * op.side;
  if (op.layer.taps == 1) {
    kernels.point_convolution({.x = memory.x + floats(first * places, op.layer.in),
                               .panels = memory.weight,
                               .bias = memory.bias,
                               .y = memory.y + floats(first * places, op.layer.out),
                               .rows = blocks * places,
                               .in = op.layer.in,
                               .out = op.layer.out,
                               .relu = op.relu});
    return;
  }
  kernels.square_convolution({.x = memory.x,
                              .map = memory.map + floats(first, op.map.columns),
                              .map_columns = op.map.columns,
                              .blocks = blocks,
                              .panels = memory.weight,
                              .bias = memory.bias,
                              .y = memory.y,
                              .side = op.side,
                              .in = op.layer.in,
                              .out = op.layer.out,
                              .columns = whole_panels(op.layer.out),
                              .relu = op.relu});
}

}  // namespace flowdlo::reference
