// Between: the two pixels of a row between which a pixel lies at another size.
#pragma once

#include <cmath>

namespace flowdlo::image {

/// Two neighbours, and the share of the second.
struct Between {
  int first = 0;
  float share = 0;
};

/// Pixel `at` where each is `scale` pixels of the given size.
[[nodiscard]] inline Between centre_of(int at, double scale) {
  const auto place = static_cast<float>((at + 0.5) * scale - 0.5);
  const auto first = static_cast<int>(std::floor(place));
  return {first, place - static_cast<float>(first)};
}

/// The same where one side grows: a pixel keeps its value as long as it covers a whole one.
/// `inverse` is that of `scale`.
[[nodiscard]] inline Between cover_of(int at, double scale, double inverse) {
  const auto first = static_cast<int>(std::floor(at * scale));
  const auto share = static_cast<float>((at + 1) - (first + 1) * inverse);
  return {first, share <= 0 ? 0.0F : share - std::floor(share)};
}

}  // namespace flowdlo::image
