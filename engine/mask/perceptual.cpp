#include "mask/perceptual.hpp"

#include <array>
#include <cmath>
#include <cstddef>

namespace flowdlo::mask {
namespace {

constexpr float kNoLight = 1e-6F;  ///< of L: below, a quotient by it says nothing

constexpr std::uint32_t kSlotBits = 14;
constexpr std::size_t kSlots = std::size_t{1} << kSlotBits;
constexpr std::uint32_t kSpread = 2654435761U;  ///< Knuth's: 2^32 by the golden ratio

/// Linear light of an sRGB code, IEC 61966-2-1.
std::array<float, 256> linear_light() {
  std::array<float, 256> table{};
  for (std::size_t code = 0; code < table.size(); ++code) {
    const double value = static_cast<double>(code) / 255;
    table[code] = static_cast<float>(value <= 0.04045 ? value / 12.92
                                                      : std::pow((value + 0.055) / 1.055, 2.4));
  }
  return table;
}

/// Linear sRGB to OKLab by the matrices of Ottosson, "A perceptual color space for image
/// processing", 2020.
Perceived of_light(float red, float green, float blue) {
  const float l = std::cbrt(0.4122214708F * red + 0.5363325363F * green + 0.0514459929F * blue);
  const float m = std::cbrt(0.2119034982F * red + 0.6806995451F * green + 0.1073969566F * blue);
  const float s = std::cbrt(0.0883024619F * red + 0.2817188376F * green + 0.6299787005F * blue);
  const float lightness = 0.2104542553F * l + 0.7936177850F * m - 0.0040720468F * s;
  const float a = 1.9779984951F * l - 2.4285922050F * m + 0.4505937099F * s;
  const float b = 0.0259040371F * l + 0.7827717662F * m - 0.8086757660F * s;
  if (lightness < kNoLight) return {};
  return {lightness, a / lightness, b / lightness};
}

}  // namespace

Perceived perceived(std::uint8_t red, std::uint8_t green, std::uint8_t blue) {
  const auto light = linear_light();
  return of_light(light[red], light[green], light[blue]);
}

Perceiver::Perceiver() : light_(linear_light()), known_(kSlots) {}

const Perceived& Perceiver::operator()(const std::uint8_t* bgr) {
  const std::uint32_t code =
      (std::uint32_t{bgr[2]} << 16U) + (std::uint32_t{bgr[1]} << 8U) + bgr[0];
  Known& known = known_[code * kSpread >> (32U - kSlotBits)];
  if (known.code != code) known = {code, of_light(light_[bgr[2]], light_[bgr[1]], light_[bgr[0]])};
  return known.color;
}

std::vector<Perceived> perceived(std::span<const std::uint8_t> color_bgr) {
  Perceiver perceiver;
  std::vector<Perceived> out;
  out.reserve(color_bgr.size() / 3);
  for (std::size_t at = 0; at + 2 < color_bgr.size(); at += 3) {
    out.push_back(perceiver(&color_bgr[at]));
  }
  return out;
}

}  // namespace flowdlo::mask
