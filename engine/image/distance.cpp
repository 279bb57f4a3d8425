// Two passes, each with the neighbours that it has behind it. Those of the rows above or below do
// not depend on each other and are taken many at a time; what the row itself hands on comes after.
#include "image/distance.hpp"

#include <algorithm>
#include <limits>
#include <vector>

#include "image/lanes.hpp"

namespace flowdlo::image {
namespace {

constexpr int kOne = 65536;
constexpr int kAslant = 91750;   // 1.4
constexpr int kKnight = 143976;  // 2.1969
constexpr int kFar = std::numeric_limits<int>::max() / 4;
constexpr int kBorder = 2;

// The least of what the two rows behind a pixel hand to it; `near` is the one beside it.
[[gnu::always_inline]] inline int from_rows(const int* near, const int* next, int u) {
  const int knight =
      std::min(std::min(next[u - 1], next[u + 1]), std::min(near[u - 2], near[u + 2]));
  const int aslant = std::min(near[u - 1], near[u + 1]);
  return std::min(knight + kKnight, std::min(aslant + kAslant, near[u] + kOne));
}

// `to` is at most what the rows behind it say.
[[gnu::always_inline]] inline void take_rows(const int* near, const int* next, int* __restrict to,
                                             int count) {
  for (int u = 0; u < count; ++u) to[u] = std::min(to[u], from_rows(near, next, u));
}

using Pass = void (*)(const int*, const int*, int*, int);

void plain_rows(const int* near, const int* next, int* to, int count) {
  take_rows(near, next, to, count);
}
#ifdef FLOWDLO_WIDE_LANES
FLOWDLO_WIDE_LANES void wide_rows(const int* near, const int* next, int* to, int count) {
  take_rows(near, next, to, count);
}
#endif

Pass pass() {
#ifdef FLOWDLO_WIDE_LANES
  if (has_wide_lanes()) return wide_rows;
#endif
  return plain_rows;
}

struct Span {
  int begin = 0;
  int end = 0;
};

// From the first pixel of a row that is set to behind the last.
Span set_in(const std::uint8_t* row, int width) {
  Span span{0, width};
  while (span.begin < width && row[span.begin] == 0) ++span.begin;
  while (span.end > span.begin && row[span.end - 1] == 0) --span.end;
  return span;
}

}  // namespace

Image<float> distance_to_empty(const Image<const std::uint8_t>& mask) {
  const int width = mask.width();
  const int height = mask.height();
  const Pass take = pass();
  Image<int> whole({width + 2 * kBorder, height + 2 * kBorder});
  const auto row = [&](int v) { return whole.row(v + kBorder) + kBorder; };
  for (const int v : {-2, -1, height, height + 1}) {
    std::fill_n(whole.row(v + kBorder), whole.width(), kFar);
  }
  std::vector<Span> spans;
  for (int v = 0; v < height; ++v) {
    const std::uint8_t* const set = mask.row(v);
    const Span span = set_in(set, width);
    spans.push_back(span);
    int* const to = row(v);
    std::fill(to - kBorder, to, kFar);
    std::fill(to, to + span.begin, 0);
    for (int u = span.begin; u < span.end; ++u) to[u] = set[u] == 0 ? 0 : kFar;
    std::fill(to + span.end, to + width, 0);
    std::fill(to + width, to + width + kBorder, kFar);
    take(row(v - 1) + span.begin, row(v - 2) + span.begin, to + span.begin, span.end - span.begin);
    int least = to[span.begin - 1];
    for (int u = span.begin; u < span.end; ++u) {
      least = std::min(to[u], least + kOne);
      to[u] = least;
    }
  }
  Image<float> distance(mask.size());
  for (int v = height - 1; v >= 0; --v) {
    const auto [begin, end] = spans[static_cast<std::size_t>(v)];
    int* const to = row(v);
    take(row(v + 1) + begin, row(v + 2) + begin, to + begin, end - begin);
    int least = to[end];
    for (int u = end - 1; u >= begin; --u) {
      least = std::min(to[u], least + kOne);
      to[u] = least;
    }
    float* const pixels = distance.row(v);
    for (int u = 0; u < width; ++u) pixels[u] = static_cast<float>(to[u]) * (1.0F / kOne);
  }
  return distance;
}

}  // namespace flowdlo::image
