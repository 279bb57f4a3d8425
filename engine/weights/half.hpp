// Half: IEEE 754 binary16 as stored in weights files. Integer arithmetic and exact scaling, so that
// neither the rounding mode nor flush-to-zero of the calling process changes a value.
#pragma once

#include <bit>
#include <cstdint>

namespace flowdlo::weights {

inline constexpr float kLargestHalf = 65504.0F;

/// The float of the same value; exact, subnormals, infinities and NaN included.
[[nodiscard]] inline float half_to_float(std::uint16_t half) {
  const std::uint32_t sign = (half & 0x8000U) << 16U;
  const std::uint32_t magnitude = half & 0x7FFFU;
  const std::uint32_t exponent_gap = magnitude >= 0x7C00U ? 0x70000000U : 0x38000000U;
  const std::uint32_t normal = (magnitude << 13U) + exponent_gap;
  const float subnormal = static_cast<float>(static_cast<std::int32_t>(magnitude)) * 0x1p-24F;
  const std::uint32_t bits = magnitude < 0x0400U ? std::bit_cast<std::uint32_t>(subnormal) : normal;
  return std::bit_cast<float>(bits | sign);
}

/// Rounds to nearest, ties to even. Magnitudes from 65520 up become infinity; NaN stays NaN.
[[nodiscard]] std::uint16_t float_to_half(float value);

}  // namespace flowdlo::weights
