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

constexpr int kIndexBits = 22;         // 2048 x 2048 pixels: half of the largest frame
constexpr std::int32_t kNoPixel = -1;  // nothing set in the column

/// The cost of a column's nearest set pixel, seen from any pixel of the current row.
struct Parabola {
  int column;
  std::int64_t offset;  // squared vertical distance * 2^22 + index
  int begin;            // first u at which it is the lowest
};

/// [height, width] row of the nearest set pixel within each column, ties to the upper one.
std::vector<std::int32_t> nearest_rows(std::span<const std::uint8_t> set, int width, int height) {
  std::vector<std::int32_t> rows(set.size(), kNoPixel);
  const auto at = [width](int u, int v) { return static_cast<std::size_t>(v * width + u); };
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      if (set[at(u, v)] != 0) {
        rows[at(u, v)] = v;
      } else if (v > 0) {
        rows[at(u, v)] = rows[at(u, v - 1)];
      }
    }
  }
  for (int v = height - 2; v >= 0; --v) {
    for (int u = 0; u < width; ++u) {
      const std::int32_t below = rows[at(u, v + 1)];
      const std::int32_t above = rows[at(u, v)];
      const bool below_wins = below > v && (above == kNoPixel || below - v < v - above);
      if (below_wins) rows[at(u, v)] = below;
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

/// Pushes the parabola of one column, removing those it makes superfluous.
void push(std::vector<Parabola>& envelope, Parabola next, int width) {
  while (!envelope.empty()) {
    next.begin = first_below(envelope.back(), next);
    if (next.begin > envelope.back().begin) break;
    envelope.pop_back();
  }
  if (envelope.empty()) next.begin = 0;
  if (next.begin < width) envelope.push_back(next);
}

}  // namespace

std::vector<std::int32_t> nearest_set_pixel(std::span<const std::uint8_t> set, int width,
                                            int height) {
  assert(set.size() == static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  assert(set.size() <= std::size_t{1} << kIndexBits);
  const std::vector<std::int32_t> rows = nearest_rows(set, width, height);
  std::vector<std::int32_t> nearest(set.size());
  std::vector<Parabola> envelope;
  envelope.reserve(static_cast<std::size_t>(width));
  for (int v = 0; v < height; ++v) {
    const auto row = static_cast<std::size_t>(v) * static_cast<std::size_t>(width);
    envelope.clear();
    for (int u = 0; u < width; ++u) {
      const std::int32_t v_set = rows[row + static_cast<std::size_t>(u)];
      if (v_set == kNoPixel) continue;
      const std::int64_t vertical = v_set - v;
      const std::int64_t index = std::int64_t{v_set} * width + u;
      push(envelope, {u, ((vertical * vertical) << kIndexBits) + index, 0}, width);
    }
    if (envelope.empty()) return {};
    std::size_t lowest = 0;
    for (int u = 0; u < width; ++u) {
      while (lowest + 1 < envelope.size() && envelope[lowest + 1].begin <= u) ++lowest;
      const std::int64_t index = envelope[lowest].offset & ((std::int64_t{1} << kIndexBits) - 1);
      nearest[row + static_cast<std::size_t>(u)] = static_cast<std::int32_t>(index);
    }
  }
  return nearest;
}

}  // namespace flowdlo::evidence
