// Lanes: as many floats as one register of the instruction set holds, and what kernels do to them.
//
// GCC's and Clang's vector extensions, so that one text serves every processor. Everything here is
// inlined into its kernel: nothing compiled for a newer processor may be shared.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "reference/isa.hpp"

#define FLOWDLO_INLINE [[gnu::always_inline]] inline

namespace flowdlo::reference::FLOWDLO_ISA {

#if defined(__AVX512F__)
constexpr int kLanes = 16;
#elif defined(__AVX__)
constexpr int kLanes = 8;
#else
constexpr int kLanes = 4;
#endif

typedef float Lanes __attribute__((vector_size(4 * kLanes)));
typedef std::int32_t IntegerLanes __attribute__((vector_size(4 * kLanes)));

FLOWDLO_INLINE Lanes load(const float* from) {
  Lanes lanes;
  __builtin_memcpy(&lanes, from, sizeof lanes);
  return lanes;
}

FLOWDLO_INLINE void store(float* to, const Lanes& lanes) {
  __builtin_memcpy(to, &lanes, sizeof lanes);
}

FLOWDLO_INLINE Lanes all(float value) { return value - Lanes{}; }

FLOWDLO_INLINE Lanes smaller(const Lanes& a, const Lanes& b) { return a < b ? a : b; }
FLOWDLO_INLINE Lanes larger(const Lanes& a, const Lanes& b) { return a > b ? a : b; }

/// The sum of all lanes, pairwise: the same order every time.
FLOWDLO_INLINE float sum(const Lanes& lanes) {
  float part[kLanes];
  store(part, lanes);
  for (int half = kLanes / 2; half > 0; half /= 2) {
    for (int i = 0; i < half; ++i) part[i] += part[i + half];
  }
  return part[0];
}

/// e^x for x in [-87, 0], below: e^-87. Relative error below 2e-7.
FLOWDLO_INLINE Lanes exp_of_negative(const Lanes& x) {
  constexpr float kLog2e = 1.44269504088896341F;
  constexpr float kLn2High = 0.693359375F;  // exact in few bits, so that n * it is exact
  constexpr float kLn2Low = -2.12194440e-4F;
  constexpr float kRound = 12582912.0F;  // 1.5 * 2^23: adding it rounds to an integer
  const Lanes clamped = larger(x, all(-87.0F));
  const Lanes shifted = clamped * kLog2e + kRound;
  const Lanes n = shifted - kRound;
  const Lanes r = (clamped - n * kLn2High) - n * kLn2Low;
  Lanes series = r * 1.9875691500e-4F + 1.3981999507e-3F;  // Cephes' polynomial of e^r
  series = series * r + 8.3334519073e-3F;
  series = series * r + 4.1665795894e-2F;
  series = series * r + 1.6666665459e-1F;
  series = series * r + 5.0000001201e-1F;
  series = (series * r) * r + r + 1.0F;
  const IntegerLanes power = (__builtin_convertvector(n, IntegerLanes) + 127) << 23;
  Lanes scale;
  __builtin_memcpy(&scale, &power, sizeof scale);
  return series * scale;
}

}  // namespace flowdlo::reference::FLOWDLO_ISA
