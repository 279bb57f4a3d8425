#include "image/masks.hpp"

#include <algorithm>
#include <vector>

namespace flowdlo::image {
namespace {

template <class T>
Mask mask_above(const Image<const T>& image, T threshold, std::uint8_t value) {
  Mask result(image.size());
  for (int v = 0; v < image.height(); ++v) {
    const T* const from = image.row(v);
    std::uint8_t* const to = result.row(v);
    for (int u = 0; u < image.width(); ++u) to[u] = from[u] > threshold ? value : std::uint8_t{0};
  }
  return result;
}

}  // namespace

int count_set(const ConstMask& mask) {
  int count = 0;
  for (int v = 0; v < mask.height(); ++v) {
    const std::uint8_t* const row = mask.row(v);
    for (int u = 0; u < mask.width(); ++u) count += row[u] != 0 ? 1 : 0;
  }
  return count;
}

Mask above(const ConstMask& image, std::uint8_t threshold, std::uint8_t value) {
  return mask_above(image, threshold, value);
}
Mask above(const Image<const float>& image, float threshold, std::uint8_t value) {
  return mask_above(image, threshold, value);
}

Mask inverse(const ConstMask& mask) {
  Mask result(mask.size());
  for (int v = 0; v < mask.height(); ++v) {
    const std::uint8_t* const from = mask.row(v);
    std::uint8_t* const to = result.row(v);
    for (int u = 0; u < mask.width(); ++u) to[u] = from[u] == 0 ? 1 : 0;
  }
  return result;
}

bool same(const ConstMask& a, const ConstMask& b) {
  for (int v = 0; v < a.height(); ++v) {
    const bool row = std::equal(a.row(v), a.row(v) + a.width(), b.row(v),
                                [](auto x, auto y) { return (x != 0) == (y != 0); });
    if (!row) return false;
  }
  return true;
}

Mask majority(const ConstMask& mask, int side) {
  const int half = side / 2;
  const int width = mask.width();
  std::vector<int> columns(static_cast<std::size_t>(width + side), 0);  // sums of `side` rows
  const auto add = [&](int v, int sign) {
    if (v < 0 || v >= mask.height()) return;
    const std::uint8_t* const row = mask.row(v);
    int* const to = columns.data() + half + 1;
    for (int u = 0; u < width; ++u) to[u] += row[u] != 0 ? sign : 0;
  };
  for (int v = 0; v < half; ++v) add(v, 1);
  Mask result(mask.size());
  for (int v = 0; v < mask.height(); ++v) {
    add(v + half, 1);
    add(v - half - 1, -1);
    int sum = 0;
    for (int k = 0; k < side; ++k) sum += columns[static_cast<std::size_t>(k)];
    std::uint8_t* const to = result.row(v);
    for (int u = 0; u < width; ++u) {
      sum += columns[static_cast<std::size_t>(u + side)] - columns[static_cast<std::size_t>(u)];
      to[u] = 2 * sum > side * side ? 1 : 0;
    }
  }
  return result;
}

}  // namespace flowdlo::image
