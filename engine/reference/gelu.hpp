// GELU in its erf form: x/2 (1 + erf(x / sqrt 2)).
//
// erf by Abramowitz and Stegun 7.1.26, |error| below 1.5e-7; the shaders use the same form.
#pragma once

#include "reference/lanes.hpp"

namespace flowdlo::reference::FLOWDLO_ISA {

FLOWDLO_INLINE Lanes gelu(const Lanes& x) {
  constexpr float kInverseSqrt2 = 0.70710678118654752F;
  const Lanes magnitude = larger(x, -x);
  const Lanes z = magnitude * kInverseSqrt2;
  const Lanes t = 1.0F / (z * 0.3275911F + 1.0F);
  Lanes series = t * 1.061405429F - 1.453152027F;
  series = series * t + 1.421413741F;
  series = series * t - 0.284496736F;
  series = series * t + 0.254829592F;
  const Lanes tail = (series * t) * exp_of_negative(-z * z);  // 1 - erf(|x| / sqrt 2)
  return 0.5F * (x + magnitude - magnitude * tail);
}

}  // namespace flowdlo::reference::FLOWDLO_ISA
