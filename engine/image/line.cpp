#include "image/line.hpp"

#include <cstdint>
#include <cstdlib>
#include <utility>

namespace flowdlo::image {
namespace {

struct Place {
  std::int64_t x = 0;
  std::int64_t y = 0;
};

enum Side { kLeft = 1, kRight = 2, kAbove = 4, kBelow = 8 };

int sides_of(const Place& p, const Size& size) {
  return (p.x < 0 ? kLeft : 0) + (p.x >= size.width ? kRight : 0) + (p.y < 0 ? kAbove : 0) +
         (p.y >= size.height ? kBelow : 0);
}

std::int64_t share_of(std::int64_t whole, std::int64_t part, std::int64_t of) {
  return static_cast<std::int64_t>(static_cast<double>(part) * static_cast<double>(whole) /
                                   static_cast<double>(of));
}

// Cuts the line from a to b at the image's border, rounding towards a; false where none of it is
// inside.
bool clip(const Size& size, Place& a, Place& b) {
  int at_a = sides_of(a, size);
  int at_b = sides_of(b, size);
  if ((at_a & at_b) != 0 || (at_a | at_b) == 0) return (at_a | at_b) == 0;
  const auto to_rows = [&](Place& p, int& sides) {
    if ((sides & (kAbove | kBelow)) == 0) return;
    const std::int64_t y = (sides & kAbove) != 0 ? 0 : size.height - 1;
    p.x += share_of(b.x - a.x, y - p.y, b.y - a.y);
    p.y = y;
    sides = sides_of(p, size) & (kLeft | kRight);
  };
  to_rows(a, at_a);
  to_rows(b, at_b);
  if ((at_a & at_b) != 0 || (at_a | at_b) == 0) return (at_a | at_b) == 0;
  const auto to_columns = [&](Place& p, int& sides) {
    if (sides == 0) return;
    const std::int64_t x = (sides & kLeft) != 0 ? 0 : size.width - 1;
    p.y += share_of(b.y - a.y, x - p.x, b.x - a.x);
    p.x = x;
    sides = 0;
  };
  to_columns(a, at_a);
  to_columns(b, at_b);
  return true;
}

void draw_line(Mask& mask, Point from, Point to, std::uint8_t value) {
  Place a{from.x, from.y};
  Place b{to.x, to.y};
  if (!clip(mask.size(), a, b)) return;
  if (b.x < a.x) std::swap(a, b);  // from left to right, the same both ways
  auto along = b.x - a.x;
  auto across = std::abs(b.y - a.y);
  const int down = b.y < a.y ? -1 : 1;
  const bool steep = across > along;
  if (steep) std::swap(along, across);
  std::int64_t error = along - 2 * across;
  for (std::int64_t i = 0; i <= along; ++i) {
    mask.at(static_cast<int>(a.y), static_cast<int>(a.x)) = value;
    const bool sideways = error < 0;
    if (!steep || sideways) ++a.x;
    if (steep || sideways) a.y += down;
    error += sideways ? 2 * (along - across) : -2 * across;
  }
}

}  // namespace

void draw_polyline(Mask& mask, std::span<const Point> points, std::uint8_t value) {
  for (std::size_t i = 1; i < points.size(); ++i) {
    draw_line(mask, points[i - 1], points[i], value);
  }
}

}  // namespace flowdlo::image
