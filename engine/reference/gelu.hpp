// GELU in its erf form, x Phi(x), to within 1.5e-6.
//
// Phi(x) - 1/2 is odd: x times a polynomial of x^2, fitted for the least largest error of x Phi(x).
// Beyond 5.2 Phi is 0 or 1 to that accuracy. No division and no exponential: half the time of
// Abramowitz and Stegun's form, which the shaders use.
#pragma once

#include "reference/lanes.hpp"

namespace flowdlo::reference::FLOWDLO_ISA {

FLOWDLO_INLINE Lanes gelu(const Lanes& x) {
  constexpr float kEnd = 5.2F;
  constexpr float kSeries[] = {0.135949925F,   -0.0677433535F,  0.0500304066F,  -0.0399428234F,
                               0.0319050439F,  -0.0245808456F,  0.0183920301F,  -0.0131437331F,
                               0.00756197376F, -0.00345095596F, 0.00283324812F, -0.00252991915F,
                               0.000872831151F};
  constexpr int kTerms = sizeof kSeries / sizeof kSeries[0];
  const Lanes inner = smaller(larger(x, all(-kEnd)), all(kEnd));
  const Lanes v = inner * inner * (2.0F / (kEnd * kEnd)) - 1.0F;  // in [-1, 1]
  Lanes series = all(kSeries[kTerms - 1]);
#pragma GCC unroll 16
  for (int i = kTerms - 2; i >= 0; --i) series = series * v + kSeries[i];
  return x * (inner * series + 0.5F);
}

}  // namespace flowdlo::reference::FLOWDLO_ISA
