// GELU in its erf form: x/2 (1 + erf(x / sqrt 2)).
//
// erf by Abramowitz and Stegun 7.1.26, |error| below 1.5e-7; the shaders use the same form.
#pragma once

#include <Eigen/Core>

#include "reference/isa.hpp"

namespace flowdlo::reference::FLOWDLO_ISA {

/// Columns must be a multiple of 64.
template <class Derived>
inline void gelu_in_place(Eigen::ArrayBase<Derived>& x) {
  constexpr float kInverseSqrt2 = 0.70710678118654752F;
  constexpr Eigen::Index kStrip = 64;
  using Strip = Eigen::Array<float, 1, kStrip>;
  for (Eigen::Index row = 0; row < x.rows(); ++row) {
    for (Eigen::Index column = 0; column + kStrip <= x.cols(); column += kStrip) {
      auto values = x.row(row).template segment<kStrip>(column);
      const Strip z = values.abs() * kInverseSqrt2;
      const Strip t = (1.0F + 0.3275911F * z).inverse();
      const Strip poly =
          t * (0.254829592F +
               t * (-0.284496736F + t * (1.421413741F + t * (-1.453152027F + t * 1.061405429F))));
      const Strip tail = poly * (-z * z).exp();  // 1 - erf(|x| / sqrt 2)
      values = 0.5F * (values + values.abs() * (1.0F - tail));
    }
  }
}

}  // namespace flowdlo::reference::FLOWDLO_ISA
