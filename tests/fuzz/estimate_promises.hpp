// What an estimate promises whatever the frame was; see flowdlo/estimate.hpp.
#pragma once

#include <cmath>

#include "flowdlo/estimate.hpp"
#include "promise.hpp"

namespace flowdlo::fuzz {

inline bool unit(float value) { return value >= 0 && value <= 1; }

inline bool finite(const Centerline& nodes) {
  for (const auto& node : nodes) {
    if (!std::isfinite(node.x) || !std::isfinite(node.y) || !std::isfinite(node.z)) return false;
  }
  return true;
}

inline void check(const Estimate& estimate) {
  promise(finite(estimate.nodes), "64 finite nodes");
  promise(unit(estimate.confidence), "the confidence is in [0, 1]");
  promise(unit(estimate.mask_agreement) && unit(estimate.prior_mask_agreement),
          "mask agreement is in [0, 1]");
  for (const float sigma_m : estimate.sigma_m) {
    promise(std::isfinite(sigma_m) && sigma_m >= 0, "every sigma is finite and not negative");
  }
  for (const auto support : estimate.support) promise(support <= 1, "support is 0 or 1");
  for (const auto& other : estimate.alternatives) {
    promise(finite(other.nodes), "alternatives have 64 finite nodes");
    promise(std::isfinite(other.score), "alternatives have a finite score");
  }
  promise(estimate.draw >= -1 && estimate.draw < static_cast<int>(estimate.draws.size()),
          "the draw is one of the draws");
}

}  // namespace flowdlo::fuzz
