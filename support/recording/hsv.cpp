#include "recording/hsv.hpp"

#include <algorithm>
#include <cmath>

namespace flowdlo::recording {
namespace {

constexpr int kShift = 12;  // of fixed-point numbers
constexpr int kHues = 180;

/// [256] `most` / i in fixed point, rounded; 0 where i is.
std::array<int, 256> shares_of(double most) {
  std::array<int, 256> shares{};
  for (int i = 1; i < 256; ++i) {
    shares[static_cast<std::size_t>(i)] = static_cast<int>(std::lrint(most * (1 << kShift) / i));
  }
  return shares;
}

/// `number` times a share of shares_of, rounded.
int rounded(int number, int share) { return (number * share + (1 << (kShift - 1))) >> kShift; }

bool within(int number, int low, int high) { return low <= number && number <= high; }

}  // namespace

std::array<int, 3> hsv_of(const support::Color& color) {
  static const std::array<int, 256> kOfSaturation = shares_of(255);
  static const std::array<int, 256> kOfHue = shares_of(kHues / 6.0);
  const int blue = color[0];
  const int green = color[1];
  const int red = color[2];
  const int value = std::max({blue, green, red});
  const int spread = value - std::min({blue, green, red});
  const int turn = value == red     ? green - blue
                   : value == green ? blue - red + 2 * spread
                                    : red - green + 4 * spread;
  const int hue = rounded(turn, kOfHue[static_cast<std::size_t>(spread)]);
  return {hue < 0 ? hue + kHues : hue,
          rounded(spread, kOfSaturation[static_cast<std::size_t>(value)]), value};
}

image::Mask hsv_mask(const support::ConstPicture& color, const HsvRange& range) {
  const auto& [low, high] = range;
  const bool through_red = low[0] > high[0];
  image::Mask mask(color.size());
  for (int v = 0; v < mask.height(); ++v) {
    for (int u = 0; u < mask.width(); ++u) {
      const auto [hue, saturation, value] = hsv_of(color.at(v, u));
      const bool in_hue =
          through_red ? hue >= low[0] || hue <= high[0] : within(hue, low[0], high[0]);
      const bool in =
          in_hue && within(saturation, low[1], high[1]) && within(value, low[2], high[2]);
      mask.at(v, u) = in ? 255 : 0;
    }
  }
  return mask;
}

}  // namespace flowdlo::recording
