#include "geometry/mask_box.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace flowdlo::geometry {
namespace {

bool lit(std::uint8_t value) { return value > 127; }

/// Of so many pixels, all looked at: many at a time.
bool any_lit(const std::uint8_t* pixels, int count) {
  std::uint8_t all = 0;
  for (int i = 0; i < count; ++i) all |= pixels[i];
  return lit(all);
}

/// Of eight pixels: above 127 is the top bit's weight.
bool eight_unlit(const std::uint8_t* pixels) {
  std::uint64_t word = 0;
  std::memcpy(&word, pixels, sizeof word);
  return (word & 0x8080808080808080U) == 0;
}

}  // namespace

int first_masked(const std::uint8_t* pixels, int from, int count) {
  while (from + 8 <= count && eight_unlit(pixels + from)) from += 8;
  while (from < count && !lit(pixels[from])) ++from;
  return from;
}

image::Rect mask_box(const Frame& frame) {
  const auto row = [&](int v) {
    return frame.mask.data() + static_cast<std::size_t>(v) * static_cast<std::size_t>(frame.width);
  };
  int top = 0;
  while (top < frame.height && !any_lit(row(top), frame.width)) ++top;
  if (top == frame.height) return {};
  int bottom = frame.height - 1;
  while (!any_lit(row(bottom), frame.width)) --bottom;
  // What lies between columns that are known to be in the box is looked at no more.
  int left = frame.width;
  int right = -1;
  for (int v = top; v <= bottom; ++v) {
    const std::uint8_t* const pixels = row(v);
    if (left == frame.width || any_lit(pixels, left)) {
      left = static_cast<int>(std::find_if(pixels, pixels + left, lit) - pixels);
    }
    if (!any_lit(pixels + right + 1, frame.width - right - 1)) continue;
    int last = frame.width - 1;
    while (!lit(pixels[last])) --last;
    right = last;
  }
  return {left, top, right - left + 1, bottom - top + 1};
}

}  // namespace flowdlo::geometry
