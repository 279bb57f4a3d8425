// Half: IEEE 754 binary16 as stored in weights files. Integer arithmetic and exact scaling, so that
// neither the rounding mode nor flush-to-zero of the calling process changes a value.
#pragma once

#include <algorithm>
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

/// Whether a half holds the value exactly. Without a branch: a model has 5.8 million values.
[[nodiscard]] inline bool is_half(float value) {
  const std::uint32_t magnitude = std::bit_cast<std::uint32_t>(value) & 0x7FFFFFFFU;
  const bool normal = (magnitude & 0x1FFFU) == 0 && magnitude < 0x47800000U;
  // A subnormal half is a multiple of 2^-24; 2^-14 is the smallest normal one.
  const float units = std::bit_cast<float>(std::min(magnitude, 0x38800000U)) * 0x1p24F;
  const bool subnormal = static_cast<float>(static_cast<std::int32_t>(units)) == units;
  const bool tiny = magnitude != 0 && magnitude < 0x00800000U;  // flush-to-zero may hide it
  return magnitude < 0x38800000U ? subnormal && !tiny : normal;
}

/// The half of a value for which is_half is true.
[[nodiscard]] inline std::uint16_t exact_half(float value) {
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(value);
  const std::uint32_t magnitude = bits & 0x7FFFFFFFU;
  const std::uint32_t normal = (magnitude - 0x38000000U) >> 13U;
  const float units = std::bit_cast<float>(std::min(magnitude, 0x38800000U)) * 0x1p24F;
  const auto subnormal = static_cast<std::uint32_t>(static_cast<std::int32_t>(units));
  const std::uint32_t half = magnitude < 0x38800000U ? subnormal : normal;
  return static_cast<std::uint16_t>(half | (bits >> 16U & 0x8000U));
}

/// Rounds to nearest, ties to even. Magnitudes from 65520 up become infinity; NaN stays NaN.
[[nodiscard]] std::uint16_t float_to_half(float value);

}  // namespace flowdlo::weights
