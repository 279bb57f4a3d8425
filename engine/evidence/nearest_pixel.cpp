// Two passes: the nearest set pixel of each column, then per row the lower envelope of the
// parabolas (u - column)^2 + offset. Idea: Felzenszwalb and Huttenlocher, "Distance transforms of
// sampled functions", 2012; Meijster et al., 2000.
//
// Ties: each parabola is scaled by 2^22 and its pixel's index is added. The index is below 2^22, so
// it decides between equal distances only, and no two parabolas meet at a pixel: what wins the
// envelope is the nearest pixel of lowest index, and integers keep it exact.
#include "evidence/nearest_pixel.hpp"

#include <cassert>
#include <cstddef>

namespace flowdlo::evidence {
namespace {

constexpr int kIndexBits = 22;  // 2048 x 2048 pixels: half of the largest frame

/// The row of a column in which nothing is set: above the image by more than it can be high.
constexpr std::int32_t kNoRow = -(1 << (kIndexBits + 1));

/// [height, width] row of the nearest set pixel within each column, ties to the upper one.
std::vector<std::int32_t> nearest_rows(std::span<const std::uint8_t> set, int width, int height) {
  std::vector<std::int32_t> rows(set.size());
  const auto stride = static_cast<std::size_t>(width);
  for (int v = 0; v < height; ++v) {  // of those above
    const std::uint8_t* const pixels = set.data() + static_cast<std::size_t>(v) * stride;
    std::int32_t* const row = rows.data() + static_cast<std::size_t>(v) * stride;
    for (std::size_t u = 0; u < stride; ++u) {
      const std::int32_t above = v > 0 ? *(row + u - stride) : kNoRow;
      row[u] = pixels[u] != 0 ? v : above;
    }
  }
  for (int v = height - 2; v >= 0; --v) {  // and of those below
    std::int32_t* const row = rows.data() + static_cast<std::size_t>(v) * stride;
    const std::int32_t* const next = row + stride;
    for (std::size_t u = 0; u < stride; ++u) {
      const bool nearer = next[u] > v && next[u] - v < v - row[u];
      row[u] = nearer ? next[u] : row[u];
    }
  }
  return rows;
}

/// First u from which on `right` lies below `left`; left.column < right.column.
int first_below(const Parabola& left, const Parabola& right) {
  const std::int64_t columns = right.column - left.column;
  const std::int64_t sum = right.column + left.column;
  // floor(floor(a / 2^22) / n) = floor(a / (2^22 n)); the shift rounds down.
  const std::int64_t numerator = columns * sum + ((right.offset - left.offset) >> kIndexBits);
  const std::int64_t divisor = 2 * columns;
  const std::int64_t quotient = numerator / divisor;
  return static_cast<int>(numerator % divisor < 0 ? quotient - 1 : quotient) + 1;
}

/// One row of the image.
struct Row {
  int v;
  int width;
  const std::int32_t* rows;  // [width] of each column's nearest set pixel
  Parabola* envelope;        // [width] scratch
  Pixel* nearest;            // [width] to be filled

  [[nodiscard]] bool is_set(int u) const { return rows[u] == v; }
};

/// The parabolas of columns `first` to `last` that are the lowest somewhere among them, from left
/// to right, in row.envelope; their number comes back.
int build_envelope(const Row& row, int first, int last) {
  int count = 0;
  for (int u = first; u <= last; ++u) {
    if (row.rows[u] == kNoRow) continue;
    const std::int64_t vertical = row.rows[u] - row.v;
    const std::int64_t index = std::int64_t{row.rows[u]} * row.width + u;
    Parabola next{u, ((vertical * vertical) << kIndexBits) + index, first};
    while (count > 0) {
      next.begin = first_below(row.envelope[count - 1], next);
      if (next.begin > row.envelope[count - 1].begin) break;
      --count;
    }
    if (count == 0) next.begin = first;
    if (next.begin <= last) row.envelope[count++] = next;
  }
  return count;
}

/// What is nearest to the pixels from `first` to `last`, among those columns. False when nothing is
/// set in them.
bool fill(const Row& row, int first, int last) {
  const int count = build_envelope(row, first, last);
  for (int i = 0; i < count; ++i) {
    const int end = i + 1 < count ? row.envelope[i + 1].begin : last + 1;
    const int column = row.envelope[i].column;
    const Pixel pixel{column, row.rows[column]};
    for (int u = row.envelope[i].begin; u < end; ++u) row.nearest[u] = pixel;
  }
  return count > 0;
}

/// The whole row. Between two of its own set pixels nothing beyond them can be nearest: each
/// stretch between neighbours is filled by itself. False when nothing is set in any column.
bool fill(const Row& row) {
  int first = 0;
  for (int u = 0; u < row.width; ++u) {
    if (!row.is_set(u)) continue;
    row.nearest[u] = {u, row.v};
    const bool beside = u - first <= 1 && row.is_set(first);
    if (!beside) (void)fill(row, first, u);
    first = u;
  }
  const bool done = first == row.width - 1 && row.is_set(first);
  return done || fill(row, first, row.width - 1);
}

}  // namespace

NearestPixels::NearestPixels(std::span<const std::uint8_t> set, int width, int height)
    : width_(width),
      rows_(nearest_rows(set, width, height)),
      envelope_(static_cast<std::size_t>(width)),
      nearest_(static_cast<std::size_t>(width)) {
  assert(set.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  assert(set.size() <= std::size_t{1} << kIndexBits);
}

std::span<const Pixel> NearestPixels::of_row(int v) {
  const auto row = static_cast<std::size_t>(v) * static_cast<std::size_t>(width_);
  const bool found = fill({v, width_, rows_.data() + row, envelope_.data(), nearest_.data()});
  return found ? std::span<const Pixel>(nearest_) : std::span<const Pixel>();
}

}  // namespace flowdlo::evidence
