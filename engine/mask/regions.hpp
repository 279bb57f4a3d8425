// Regions: pixels that hang together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "flowdlo/mask.hpp"

namespace flowdlo::mask {

struct Size {
  int width = 0;
  int height = 0;

  [[nodiscard]] std::size_t pixels() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
};

/// Pixels by where they are in an image, row by row.
using Places = std::vector<std::uint32_t>;

/// Pixels of an area of an image 640 px wide, in one of this size.
[[nodiscard]] float area_px2(float area_of_640, const Size& size);

/// Calls visit(neighbour) for the pixels beside and, where `diagonals`, across from `pixel`.
template <class Visit>
void for_each_neighbour(std::size_t pixel, const Size& size, bool diagonals, const Visit& visit) {
  const auto width = static_cast<std::size_t>(size.width);
  const auto at = static_cast<std::uint32_t>(pixel);  // for quick divisions
  const auto row = static_cast<std::uint32_t>(size.width);
  const bool left = at % row > 0;
  const bool right = at % row + 1 < row;
  const bool above = at >= row;
  const bool below = at / row + 1 < static_cast<std::uint32_t>(size.height);
  if (above) {
    if (diagonals && left) visit(pixel - width - 1);
    visit(pixel - width);
    if (diagonals && right) visit(pixel - width + 1);
  }
  if (left) visit(pixel - 1);
  if (right) visit(pixel + 1);
  if (below) {
    if (diagonals && left) visit(pixel + width - 1);
    visit(pixel + width);
    if (diagonals && right) visit(pixel + width + 1);
  }
}

/// Everything that can be reached from `front`, whose pixels are set already, over pixels that are
/// not: may_go(from, to) says whether a step may be taken. Sets what is reached, and gives it in
/// the order in which it was, the pixels of `front` first.
template <class MayGo>
Places flood(Mask& reached, Places front, const Size& size, const MayGo& may_go) {
  for (std::size_t next = 0; next < front.size(); ++next) {
    const std::size_t from = front[next];
    for_each_neighbour(from, size, /*diagonals=*/true, [&](std::size_t to) {
      if (reached[to] != 0 || !may_go(from, to)) return;
      reached[to] = 255;
      front.push_back(static_cast<std::uint32_t>(to));
    });
  }
  return front;
}

/// How well a pixel fits what is looked for.
enum class Fit : std::uint8_t { kNot, kWeak, kStrong };

/// 255 where a pixel fits strongly, or weakly and hangs together with one that does.
[[nodiscard]] Mask connected_to_strong(const std::vector<Fit>& fits, const Size& size);

}  // namespace flowdlo::mask
