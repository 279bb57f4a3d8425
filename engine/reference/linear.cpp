// Twin of shaders/gemm: y = act(x W^T + b) + residual.
//
// The weights lie in panels of kPanel columns, [panel][in][kPanel], read from end to end. A block
// of 256 inputs of a panel stays in the nearest cache while the rows go by.
//
// On ARM64 weights that are binary16 stay so: one block at a time is widened, which is exact. Half
// the memory is read. Products of binary16 itself are not used: activations rounded to it miss the
// 1e-4 of tests/train/golden_test.cpp, and FMLAL adds no more products an instruction than FMLA.
#include "reference/gelu.hpp"
#include "reference/isa.hpp"
#include "reference/tile.hpp"

namespace flowdlo::reference::FLOWDLO_ISA {
namespace {

// The two depths there are: constants, so that the rows of a tile lie at fixed distances.
constexpr int kShort = ops::kWidth;
constexpr int kLong = 4 * ops::kWidth;
constexpr int kDepth = 256;  // inputs of a panel taken at once

constexpr int kGroup = 16;  // inputs between two requests for the next weights
constexpr int kLine = 64;   // bytes of a cache line

/// One block of a panel, [kDepth][kPanel].
struct Block {
  const float* weights;
  const char* stored;    // where they came from; the next block follows
  std::ptrdiff_t bytes;  // that they take there
};

#if defined(__aarch64__)
/// A block's floats of the same values.
FLOWDLO_INLINE void widen(const std::uint16_t* halves, float* to) {
#pragma GCC unroll 4
  for (int i = 0; i < kDepth * kPanel; i += 2 * kLanes) {
    const float16x8_t both = vreinterpretq_f16_u16(vld1q_u16(halves + i));
    vst1q_f32(to + i, vcvt_f32_f16(vget_low_f16(both)));
    vst1q_f32(to + i + kLanes, vcvt_high_f32_f16(both));
  }
}
#endif

/// The block at `first` of the panels; `widened` is memory for it.
FLOWDLO_INLINE Block block_at(const LinearBlock& block, std::ptrdiff_t first,
                              [[maybe_unused]] float* widened) {
  const auto bytes = [](const void* memory) { return static_cast<const char*>(memory); };
  constexpr std::ptrdiff_t kValues = static_cast<std::ptrdiff_t>(kDepth) * kPanel;
#if defined(__aarch64__)
  if (block.half_panels != nullptr) {
    const std::uint16_t* const halves = block.half_panels + first;
    widen(halves, widened);
    return {widened, bytes(halves), kValues * static_cast<std::ptrdiff_t>(sizeof *halves)};
  }
#endif
  const float* const floats = block.panels + first;
  return {floats, bytes(floats), kValues * static_cast<std::ptrdiff_t>(sizeof *floats)};
}

/// Requests, while one block of weights is at work, of the block after it: it comes from the
/// third-level cache or from memory, every step again. Spread over the work, as a burst would
/// keep the rows from coming in.
struct Ahead {
  const char* at;
  std::ptrdiff_t step;  // bytes, for each group of inputs

  FLOWDLO_INLINE Ahead(const Block& block, int row, int rows, int tile_rows)
      : at(block.stored + block.bytes * (rows + row) / rows),
        step(block.bytes / (kDepth / kGroup) * tile_rows / rows) {}

  FLOWDLO_INLINE void request() {
    for (std::ptrdiff_t i = 0; i < step; i += kLine) __builtin_prefetch(at + i, 0, 2);
    at += step;
  }
};

enum class Last { kNo, kPlain, kGelu };

/// One tile of y over one block of inputs: sums start from bias and residual, or from y.
template <int kIn, int kRows>
FLOWDLO_INLINE void multiply(const LinearBlock& block, const Block& inputs, int row, int column,
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
  const float* const x = block.x + at(row, kIn) + depth_begin;
  Ahead ahead(inputs, row, block.rows, kRows);
  for (int k = 0; k < kDepth; k += kGroup) {
    ahead.request();
    accumulate(tile, x + k, kIn, 1, inputs.weights + at(k, kPanel), kPanel, kGroup);
  }
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

template <int kIn>
FLOWDLO_INLINE void linear_of(const LinearBlock& block) {
  const bool with_gelu = block.activation == ops::Activation::kGelu;
  alignas(kLine) float widened[kDepth * kPanel];  // NOLINT: no library's array, as ever here
  for (int column = block.column; column < block.column + block.columns; column += kPanel) {
    const std::ptrdiff_t panel = static_cast<std::ptrdiff_t>(column) * kIn;
    for (int depth = 0; depth < kIn; depth += kDepth) {
      const Last last = depth + kDepth < kIn ? Last::kNo : with_gelu ? Last::kGelu : Last::kPlain;
      const Block inputs =
          block_at(block, panel + static_cast<std::ptrdiff_t>(depth) * kPanel, widened);
      for_tiles(block.rows, [&](int row, auto rows) {
        multiply<kIn, decltype(rows)::value>(block, inputs, row, column, depth, last);
      });
    }
  }
}

}  // namespace

void linear(const LinearBlock& block) {
  if (block.in == kShort) {
    linear_of<kShort>(block);
  } else {
    linear_of<kLong>(block);
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
