// Twin of shaders/attention: softmax(q k^T / sqrt(32)) v, one head of one draw.
//
// Queries lie along the lanes: scores are [keys, 64 queries], so that the softmax runs down the
// keys without ever crossing lanes, and both products read keys and values where they are.
#include "reference/isa.hpp"
#include "reference/tile.hpp"

namespace flowdlo::reference::FLOWDLO_ISA {
namespace {

constexpr int kQueries = ops::kRowsPerDraw;
constexpr int kChannels = ops::kHeadWidth;
constexpr float kLowest = -3.0e38F;

typedef float Four __attribute__((vector_size(16)));

/// to[column][row] = scale * from[row][column]; both sizes are multiples of 4.
template <int kRows, int kColumns>
FLOWDLO_INLINE void transpose(const float* from, std::ptrdiff_t from_step, float* to,
                              std::ptrdiff_t to_step, float scale) {
  for (int row = 0; row < kRows; row += 4) {
    for (int column = 0; column < kColumns; column += 4) {
      Four a[4];
      for (int i = 0; i < 4; ++i) {
        __builtin_memcpy(&a[i], from + (row + i) * from_step + column, sizeof(Four));
        a[i] *= scale;
      }
      const Four low01 = __builtin_shufflevector(a[0], a[1], 0, 4, 1, 5);
      const Four high01 = __builtin_shufflevector(a[0], a[1], 2, 6, 3, 7);
      const Four low23 = __builtin_shufflevector(a[2], a[3], 0, 4, 1, 5);
      const Four high23 = __builtin_shufflevector(a[2], a[3], 2, 6, 3, 7);
      const Four b[4] = {__builtin_shufflevector(low01, low23, 0, 1, 4, 5),
                         __builtin_shufflevector(low01, low23, 2, 3, 6, 7),
                         __builtin_shufflevector(high01, high23, 0, 1, 4, 5),
                         __builtin_shufflevector(high01, high23, 2, 3, 6, 7)};
      for (int i = 0; i < 4; ++i) {
        __builtin_memcpy(to + (column + i) * to_step + row, &b[i], sizeof(Four));
      }
    }
  }
}

/// y[row][query] = sum over k of x[row * row_step + k * depth_step] * panel[k][query].
FLOWDLO_INLINE void product(const float* x, std::ptrdiff_t row_step, std::ptrdiff_t depth_step,
                            int rows, const float* panel, int depth, float* y) {
  for (int column = 0; column < kQueries; column += kPanel) {
    for_tiles(rows, [&](int row, auto count) {
      constexpr int kRows = decltype(count)::value;
      Tile<kRows> tile = {};
      accumulate(tile, x + row * row_step, row_step, depth_step, panel + column, kQueries, depth);
      for (int r = 0; r < kRows; ++r) {
        for (int i = 0; i < kTileLanes; ++i) {
          store(y + (row + r) * kQueries + column + i * kLanes, tile.sums[r][i]);
        }
      }
    });
  }
}

FLOWDLO_INLINE bool valid(const AttentionBlock& block, int key) {
  return block.key_valid == nullptr || block.key_valid[4 * key + 3] > 0.5F;
}

/// Scores [keys, 64] to weights, not yet divided by their sums [64].
FLOWDLO_INLINE void exponentials(const AttentionBlock& block, float* scores, float* sums) {
  for (int query = 0; query < kQueries; query += kLanes) {
    Lanes peak = all(kLowest);
    for (int key = 0; key < block.keys; ++key) {
      if (valid(block, key)) peak = larger(peak, load(scores + key * kQueries + query));
    }
    Lanes total = {};
    for (int key = 0; key < block.keys; ++key) {
      float* const score = scores + key * kQueries + query;
      const Lanes weight = valid(block, key) ? exp_of_negative(load(score) - peak) : Lanes{};
      total += weight;
      store(score, weight);
    }
    store(sums + query, total);
  }
}

}  // namespace

void attention(const AttentionBlock& block) {
  alignas(64) float query[kChannels * kQueries];
  alignas(64) float scores[kMaxKeys * kQueries];
  alignas(64) float mixed[kChannels * kQueries];
  alignas(64) float sums[kQueries];

  bool any = false;
  for (int key = 0; key < block.keys; ++key) any = any || valid(block, key);
  if (!any) {  // spec section 6: contributes zero
    for (int row = 0; row < kQueries; ++row) {
      for (int i = 0; i < kChannels; ++i) block.out[row * block.out_stride + i] = 0;
    }
    return;
  }
  const float scale = 1.0F / __builtin_sqrtf(static_cast<float>(kChannels));
  transpose<kQueries, kChannels>(block.query, block.query_stride, query, kQueries, scale);
  product(block.key, block.key_value_stride, 1, block.keys, query, kChannels, scores);
  exponentials(block, scores, sums);
  product(block.value, 1, block.key_value_stride, kChannels, scores, block.keys, mixed);
  for (int i = 0; i < kQueries; i += kLanes) {
    const Lanes share = 1.0F / load(sums + i);
    for (int channel = 0; channel < kChannels; ++channel) {
      float* const at = mixed + channel * kQueries + i;
      store(at, load(at) * share);
    }
  }
  transpose<kChannels, kQueries>(mixed, kQueries, block.out, block.out_stride, 1.0F);
}

}  // namespace flowdlo::reference::FLOWDLO_ISA
