// Variant: which velocity model a weights file holds. Spec section 6; chosen by metadata alone.
#pragma once

#include "ops/program.hpp"

namespace flowdlo::weights {

enum class NormalizationKind { kGlobal, kFrame };  ///< Eq. (3.8)-(3.10), or the frame's own points
enum class PriorKind { kThesis, kRefined };

struct Variant {
  ops::Parameterization parameterization = ops::Parameterization::kVelocity;
  int local_channels = 6;      ///< 6, or 8 with the depth residual of Eq. (3.16)
  bool visible_points = true;  ///< false: no points.* and no cross.* tensors
  int head_channels = 3;       ///< 4: the fourth is log-sigma of the node's error, normalised units
  NormalizationKind normalization = NormalizationKind::kGlobal;
  PriorKind prior_kind = PriorKind::kThesis;
  float prior_sd = 0.1F;  ///< s of the preconditioned form, normalised units
  int local_features_version = 1;

  friend bool operator==(const Variant&, const Variant&) = default;
};

}  // namespace flowdlo::weights
