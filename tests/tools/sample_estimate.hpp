// An estimate made by hand: a horizontal rope at 0.5 m, nodes 20 to 29 bridged.
#pragma once

#include <cstddef>

#include "flowdlo/estimate.hpp"

namespace flowdlo::test {

/// From x = -0.15 m to 0.14 m: under a camera of 100 px focal length and centre (39.5, 29.5) from
/// column 9.5 to 67.5, row 29.5.
inline Estimate sample_estimate() {
  Estimate estimate;
  for (std::size_t j = 0; j < estimate.nodes.size(); ++j) {
    estimate.nodes[j] = {-0.15F + 0.29F * static_cast<float>(j) / 63.0F, 0.0F, 0.5F};
    estimate.support[j] = j < 20 || j > 29 ? 1 : 0;
    estimate.sigma_m[j] = 0.002F;
  }
  estimate.source = Source::kPrediction;
  estimate.draw = 1;
  estimate.confidence = 0.8F;
  estimate.mask_agreement = 0.95F;
  estimate.prior_mask_agreement = 0.9F;
  estimate.readings = 5;
  estimate.draws = {{false, true, 2.5F, 0.2F, 0.4F}, {true, true, 1.01F, 0.02F, 0.95F}};
  estimate.alternatives = {{estimate.nodes, 0.5F, 0.7F}};
  estimate.timings.model_ms = 12.0;
  estimate.timings.total_ms = 20.0;
  estimate.timings.device_ms = {{"points", 1.5}, {"step", 9.0}};
  return estimate;
}

/// That rope and an upright one through its middle, a centimetre nearer, which is a ring.
inline Ropes sample_ropes() {
  Ropes ropes;
  ropes.ropes = {sample_estimate(), sample_estimate()};
  for (std::size_t j = 0; j < kNodes; ++j) {
    ropes.ropes[1].nodes[j] = {0.0F, -0.1F + 0.2F * static_cast<float>(j) / 63.0F, 0.49F};
    ropes.ropes[1].support[j] = 1;
  }
  ropes.ropes[1].closed = true;
  ropes.crossings = {{1, 0, 0.1F, 0.15F, 0.01F}};
  ropes.total_ms = 40.0;
  return ropes;
}

}  // namespace flowdlo::test
