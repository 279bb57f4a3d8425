// Perceptual: colours in OKLab, and the part of them that light does not change.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace flowdlo::mask {

/// L, a and b of OKLab are third roots of linear light up to a matrix: light k times as bright
/// multiplies all of them by k^(1/3), so that a/L and b/L stay.
struct Perceived {
  float lightness = 0;    ///< L, 0 black, 1 white
  float green_red = 0;    ///< a/L; 0 without light
  float blue_yellow = 0;  ///< b/L; the same
};

/// Of one sRGB colour.
[[nodiscard]] Perceived perceived(std::uint8_t red, std::uint8_t green, std::uint8_t blue);

/// The same of one pixel after another: three roots take long, and an image has few colours.
class Perceiver {
 public:
  Perceiver();

  /// Of a pixel's three bytes, blue first. Valid until the next call.
  const Perceived& operator()(const std::uint8_t* bgr);

 private:
  struct Known {
    std::uint32_t code = ~0U;  ///< red, green and blue from the top; no colour has this one
    Perceived color;
  };

  std::array<float, 256> light_;  ///< linear light of each code
  std::vector<Known> known_;      ///< the last colour of each slot
};

/// Of every pixel of an image [pixels, 3], blue first.
[[nodiscard]] std::vector<Perceived> perceived(std::span<const std::uint8_t> color_bgr);

/// Squared distance of two chromaticities.
[[nodiscard]] inline float chromatic_distance2(const Perceived& one, const Perceived& other) {
  const float a = one.green_red - other.green_red;
  const float b = one.blue_yellow - other.blue_yellow;
  return a * a + b * b;
}

}  // namespace flowdlo::mask
