// The least of n neighbours is found by doubling: of 2, of 4, of 8, and at last of two overlapping
// stretches. Each step takes a row at a time, so the cost grows with the logarithm of a brush.
#include "image/brush.hpp"

#include <algorithm>
#include <utility>
#include <vector>

namespace flowdlo::image {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::uint8_t kNothing = 0;

struct Least {
  static std::uint8_t of(std::uint8_t a, std::uint8_t b) { return a < b ? a : b; }
};
struct Largest {
  static std::uint8_t of(std::uint8_t a, std::uint8_t b) { return a > b ? a : b; }
};

template <class Take>
void take_pairs(const std::uint8_t* a, const std::uint8_t* b, std::uint8_t* __restrict to,
                int count) {
  for (int i = 0; i < count; ++i) to[i] = Take::of(a[i], b[i]);
}
template <class Take>
void take_in(const std::uint8_t* __restrict other, std::uint8_t* __restrict to, int count) {
  for (int i = 0; i < count; ++i) to[i] = Take::of(to[i], other[i]);
}

// Along rows: nothing lies beside them.
template <class Take>
Mask along_rows(const Image<const std::uint8_t>& mask, int half) {
  if (half == 0) return mask.clone();
  const int n = 2 * half + 1;
  const int width = mask.width();
  const std::size_t whole = static_cast<std::size_t>(width) + 2 * static_cast<std::size_t>(half);
  Mask result(mask.size());
  Bytes line(whole);
  Bytes other(whole);
  for (int v = 0; v < mask.height(); ++v) {
    std::fill_n(line.begin(), half, kNothing);
    std::copy_n(mask.row(v), width, line.begin() + half);
    std::fill(line.begin() + half + width, line.end(), kNothing);
    int length = static_cast<int>(whole);  // bytes that hold what is taken of `have`
    int have = 1;
    for (; 2 * have < n; have *= 2) {
      length -= have;
      take_pairs<Take>(line.data(), line.data() + have, other.data(), length);
      std::swap(line, other);
    }
    take_pairs<Take>(line.data(), line.data() + n - have, result.row(v), width);
  }
  return result;
}

// Down columns: nothing lies above and below them.
template <class Take>
Mask along_columns(const Mask& mask, int half) {
  if (half == 0) return mask;
  const int n = 2 * half + 1;
  const int width = mask.width();
  Mask tall({width, mask.height() + 2 * half});
  for (int v = 0; v < tall.height(); ++v) {
    const int from = v - half;
    if (from < 0 || from >= mask.height()) {
      std::fill_n(tall.row(v), width, kNothing);
    } else {
      std::copy_n(mask.row(from), width, tall.row(v));
    }
  }
  int rows = tall.height();
  int have = 1;
  for (; 2 * have < n; have *= 2) {
    rows -= have;
    for (int v = 0; v < rows; ++v) take_in<Take>(tall.row(v + have), tall.row(v), width);
  }
  for (int v = 0; v < mask.height(); ++v) take_in<Take>(tall.row(v + n - have), tall.row(v), width);
  return tall.part(all_of(mask.size()));
}

}  // namespace

Mask eroded(const Image<const std::uint8_t>& mask, int half) {
  return along_columns<Least>(along_rows<Least>(mask, half), half);
}

Mask dilated(const Image<const std::uint8_t>& mask, int half) {
  return along_columns<Largest>(along_rows<Largest>(mask, half), half);
}

}  // namespace flowdlo::image
