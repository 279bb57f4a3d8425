#include "geometry/mask_box.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace flowdlo::geometry {

MaskBox mask_box(const Frame& frame) {
  int top = -1;
  int bottom = -1;
  int left = frame.width;
  int right = -1;
  for (int v = 0; v < frame.height; ++v) {
    const std::uint8_t* row = frame.mask.data() + static_cast<std::size_t>(v) * frame.width;
    const auto lit = [](std::uint8_t value) { return value > 127; };
    const std::uint8_t* end = row + frame.width;
    const std::uint8_t* first = std::find_if(row, end, lit);
    if (first == end) continue;
    const std::uint8_t* last = end - 1;
    while (!lit(*last)) --last;
    if (top < 0) top = v;
    bottom = v;
    left = std::min(left, static_cast<int>(first - row));
    right = std::max(right, static_cast<int>(last - row));
  }
  if (top < 0) return {};
  return {left, top, right - left + 1, bottom - top + 1};
}

}  // namespace flowdlo::geometry
