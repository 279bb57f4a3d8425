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

/// Pixels of an area of an image 640 px wide, in one of this size.
[[nodiscard]] float area_px2(float area_of_640, const Size& size);

/// Calls visit(neighbour) for the pixels beside and, where `diagonals`, across from `pixel`.
template <class Visit>
void for_each_neighbour(std::size_t pixel, const Size& size, bool diagonals, const Visit& visit) {
  const auto width = static_cast<std::size_t>(size.width);
  const int u = static_cast<int>(pixel % width);
  const int v = static_cast<int>(pixel / width);
  for (int dv = -1; dv <= 1; ++dv) {
    for (int du = -1; du <= 1; ++du) {
      if ((du == 0 && dv == 0) || (!diagonals && du != 0 && dv != 0)) continue;
      if (u + du < 0 || u + du >= size.width || v + dv < 0 || v + dv >= size.height) continue;
      visit(static_cast<std::size_t>(v + dv) * width + static_cast<std::size_t>(u + du));
    }
  }
}

/// Everything that can be reached from `front`, whose pixels are set already, over pixels that are
/// not: may_go(from, to) says whether a step may be taken. Sets what is reached.
template <class MayGo>
void flood(Mask& reached, std::vector<std::size_t> front, const Size& size, const MayGo& may_go) {
  while (!front.empty()) {
    const std::size_t from = front.back();
    front.pop_back();
    for_each_neighbour(from, size, /*diagonals=*/true, [&](std::size_t to) {
      if (reached[to] != 0 || !may_go(from, to)) return;
      reached[to] = 255;
      front.push_back(to);
    });
  }
}

/// How well a pixel fits what is looked for.
enum class Fit : std::uint8_t { kNot, kWeak, kStrong };

/// 255 where a pixel fits strongly, or weakly and hangs together with one that does.
[[nodiscard]] Mask connected_to_strong(const std::vector<Fit>& fits, const Size& size);

}  // namespace flowdlo::mask
