#include "weights/half.hpp"

namespace flowdlo::weights {
namespace {

std::uint32_t shift_to_nearest_even(std::uint32_t value, std::uint32_t shift) {
  const std::uint32_t kept = value >> shift;
  const std::uint32_t rest = value & ((1U << shift) - 1U);
  const std::uint32_t half = 1U << (shift - 1U);
  const bool up = rest > half || (rest == half && (kept & 1U) != 0);
  return kept + (up ? 1U : 0U);
}

}  // namespace

std::uint16_t float_to_half(float value) {
  constexpr std::uint32_t kInfinity = 0x7F800000U;
  constexpr std::uint32_t kTwoTo16 = 0x47800000U;       // past the last exponent of a half
  constexpr std::uint32_t kTwoToMinus14 = 0x38800000U;  // smallest normal half
  constexpr std::uint32_t kFirstExponent = 102;         // below 2^-25 everything rounds to zero
  const auto bits = std::bit_cast<std::uint32_t>(value);
  const std::uint32_t magnitude = bits & 0x7FFFFFFFU;
  const std::uint32_t exponent = magnitude >> 23U;
  std::uint32_t half = 0;
  if (magnitude > kInfinity) {
    half = 0x7E00U;
  } else if (magnitude >= kTwoTo16) {
    half = 0x7C00U;
  } else if (magnitude >= kTwoToMinus14) {
    // Dropping 13 mantissa bits; a carry moves into the exponent, up to infinity, as it should.
    half = shift_to_nearest_even(magnitude - 0x38000000U, 13);
  } else if (exponent >= kFirstExponent) {
    const std::uint32_t mantissa = (magnitude & 0x007FFFFFU) | 0x00800000U;
    half = shift_to_nearest_even(mantissa, 126U - exponent);
  }
  return static_cast<std::uint16_t>(half | (bits >> 31U) << 15U);
}

}  // namespace flowdlo::weights
