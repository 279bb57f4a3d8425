#include "image/blur.hpp"

#include <cmath>
#include <cstring>

#include "image/lanes.hpp"

namespace flowdlo::image {
namespace {

// So many pixels of a row at a time, and several of them, whose sums are held in registers.
constexpr int kLanes = 8;
constexpr int kGroups = 4;
constexpr int kTogether = kLanes * kGroups;
using Lanes
    [[gnu::vector_size(kLanes * sizeof(float)), gnu::aligned(alignof(float)), gnu::may_alias]] =
        float;
using Sums = Lanes[kGroups];

[[gnu::always_inline]] inline const Lanes& lanes(const float* from, int group) {
  return *reinterpret_cast<const Lanes*>(from + group * kLanes);
}

// A product is added in one rounding where the processor can.
template <bool kFused>
[[gnu::always_inline]] inline float added(float sum, float value, float weight) {
  if constexpr (kFused) return __builtin_fmaf(value, weight, sum);
  return sum + value * weight;
}

// `from` has a row's pixels and what lies beyond them, so many as there are taps.
template <bool kFused>
[[gnu::always_inline]] inline void along_row(const float* from, const float* taps, int count,
                                             float* to, int width) {
  int u = 0;
  for (; u + kTogether <= width; u += kTogether) {
    Sums sum;
#pragma GCC unroll 4
    for (int g = 0; g < kGroups; ++g) sum[g] = lanes(from + u, g) * taps[0];
    for (int k = 1; k < count; ++k) {
#pragma GCC unroll 4
      for (int g = 0; g < kGroups; ++g) sum[g] += lanes(from + u + k, g) * taps[k];
    }
    std::memcpy(to + u, &sum, sizeof sum);
  }
  for (; u < width; ++u) {
    float sum = from[u] * taps[0];
    for (int k = 1; k < count; ++k) sum = added<kFused>(sum, from[u + k], taps[k]);
    to[u] = sum;
  }
}

// `rows`: the middle one, the two beside it, the two beside those and so on; `taps` likewise.
template <bool kFused>
[[gnu::always_inline]] inline void across_rows(const float* const* rows, const float* taps,
                                               int half, float* to, int width) {
  int u = 0;
  for (; u + kTogether <= width; u += kTogether) {
    Sums sum;
#pragma GCC unroll 4
    for (int g = 0; g < kGroups; ++g) sum[g] = lanes(rows[0] + u, g) * taps[0];
    for (int k = 1; k <= half; ++k) {
      const float* const one = rows[2 * k - 1] + u;
      const float* const other = rows[2 * k] + u;
#pragma GCC unroll 4
      for (int g = 0; g < kGroups; ++g) sum[g] += (lanes(one, g) + lanes(other, g)) * taps[k];
    }
    std::memcpy(to + u, &sum, sizeof sum);
  }
  for (; u < width; ++u) {
    float sum = rows[0][u] * taps[0];
    for (int k = 1; k <= half; ++k) {
      sum = added<kFused>(sum, rows[2 * k - 1][u] + rows[2 * k][u], taps[k]);
    }
    to[u] = sum;
  }
}

struct Passes {
  void (*row)(const float*, const float*, int, float*, int);
  void (*rows)(const float* const*, const float*, int, float*, int);
};

#ifdef __FP_FAST_FMAF
constexpr bool kPlainIsFused = true;
#else
constexpr bool kPlainIsFused = false;
#endif

void plain_row(const float* from, const float* taps, int count, float* to, int width) {
  along_row<kPlainIsFused>(from, taps, count, to, width);
}
void plain_rows(const float* const* rows, const float* taps, int half, float* to, int width) {
  across_rows<kPlainIsFused>(rows, taps, half, to, width);
}

#ifdef FLOWDLO_WIDE_LANES
FLOWDLO_WIDE_LANES void fused_row(const float* from, const float* taps, int count, float* to,
                                  int width) {
  along_row<true>(from, taps, count, to, width);
}
FLOWDLO_WIDE_LANES void fused_rows(const float* const* rows, const float* taps, int half, float* to,
                                   int width) {
  across_rows<true>(rows, taps, half, to, width);
}
#endif

Passes passes() {
#ifdef FLOWDLO_WIDE_LANES
  if (has_wide_lanes()) return {fused_row, fused_rows};
#endif
  return {plain_row, plain_rows};
}

// Where a place before or behind a row or column of `count` pixels, at least two, is mirrored to.
int mirrored(int at, int count) {
  while (at < 0 || at >= count) at = at < 0 ? -at : 2 * (count - 1) - at;
  return at;
}

}  // namespace

std::vector<float> gaussian(int taps, double sigma_px) {
  const int half = taps / 2;
  std::vector<double> weights;
  double sum = 0;
  for (int i = 0; i < half; ++i) {
    const double twice = 2 * (i - half);
    weights.push_back(std::exp(twice * twice * (-0.125 / (sigma_px * sigma_px))));
    sum += weights.back();
  }
  const double share = 1 / (2 * sum + 1);
  std::vector<float> result(static_cast<std::size_t>(taps), static_cast<float>(share));
  for (int i = 0; i < half; ++i) {
    const auto weight = static_cast<float>(weights[static_cast<std::size_t>(i)] * share);
    result[static_cast<std::size_t>(i)] = weight;
    result[static_cast<std::size_t>(taps - 1 - i)] = weight;
  }
  return result;
}

int taps_of(double sigma_px) { return static_cast<int>(std::lrint(sigma_px * 8 + 1)) | 1; }

Image<float> blurred(const Image<const float>& image, const std::vector<float>& taps,
                     Beyond beyond) {
  const auto count = static_cast<int>(taps.size());
  const int half = count / 2;
  const int width = image.width();
  const int height = image.height();
  const bool mirrors = beyond == Beyond::kMirrored;
  const Passes pass = passes();
  Image<float> along({width, height});
  std::vector<float> line(static_cast<std::size_t>(width + 2 * half), 0.0F);
  for (int v = 0; v < height; ++v) {
    const float* const from = image.row(v);
    if (mirrors && width == 1) {  // a mirror image of one pixel is that pixel
      along.row(v)[0] = from[0];
      continue;
    }
    std::copy_n(from, width, line.begin() + half);
    if (mirrors) {
      for (int k = 1; k <= half; ++k) {
        line[static_cast<std::size_t>(half - k)] = from[mirrored(-k, width)];
        line[static_cast<std::size_t>(half + width - 1 + k)] = from[mirrored(width - 1 + k, width)];
      }
    }
    pass.row(line.data(), taps.data(), count, along.row(v), width);
  }
  if (mirrors && height == 1) return along;
  const std::vector<float> nothing(static_cast<std::size_t>(width), 0.0F);
  const auto row = [&](int v) -> const float* {
    if (v >= 0 && v < height) return along.row(v);
    return mirrors ? along.row(mirrored(v, height)) : nothing.data();
  };
  Image<float> result({width, height});
  std::vector<const float*> rows(taps.size());
  for (int v = 0; v < height; ++v) {
    rows[0] = along.row(v);
    for (int k = 1; k <= half; ++k) {
      rows[static_cast<std::size_t>(2 * k - 1)] = row(v + k);
      rows[static_cast<std::size_t>(2 * k)] = row(v - k);
    }
    pass.rows(rows.data(), taps.data() + half, half, result.row(v), width);
  }
  return result;
}

}  // namespace flowdlo::image
