#include "c_api/answers.hpp"

#include <algorithm>

namespace flowdlo::c_api {

void copy_nodes(const Centerline& nodes, float (&to)[FLOWDLO_NODES][3]) {
  for (std::size_t node = 0; node < nodes.size(); ++node) {
    to[node][0] = nodes[node].x;
    to[node][1] = nodes[node].y;
    to[node][2] = nodes[node].z;
  }
}

flowdlo_estimate plain(const Estimate& estimate) {
  flowdlo_estimate out{};
  copy_nodes(estimate.nodes, out.nodes);
  std::copy(estimate.sigma_m.begin(), estimate.sigma_m.end(), out.sigma_m);
  std::copy(estimate.support.begin(), estimate.support.end(), out.support);
  out.confidence = estimate.confidence;
  out.mask_agreement = estimate.mask_agreement;
  out.prior_mask_agreement = estimate.prior_mask_agreement;
  out.source = static_cast<std::int32_t>(estimate.source);
  out.draw = estimate.draw;
  out.calibrated = estimate.calibrated ? 1 : 0;
  out.readings = estimate.readings;
  const OneRope& one = estimate.one_rope;
  for (const Doubt doubt : one.doubts) out.doubts |= 1U << static_cast<unsigned>(doubt);
  out.alternatives = static_cast<std::int32_t>(estimate.alternatives.size());
  out.accepted_draws = static_cast<std::int32_t>(
      std::count_if(estimate.draws.begin(), estimate.draws.end(),
                    [](const DrawReport& draw) { return draw.accepted; }));
  out.explained = one.explained;
  out.slender = one.slender;
  out.sides = one.sides;
  out.even = one.even;
  out.left_over = one.left_over;
  out.off_mask = one.off_mask;
  out.bare_gap = one.bare_gap;
  out.goes_on = one.goes_on;
  const Timings& timings = estimate.timings;
  out.evidence_ms = timings.evidence_ms;
  out.field_ms = timings.field_ms;
  out.path_ms = timings.path_ms;
  out.prior_ms = timings.prior_ms;
  out.readings_ms = timings.readings_ms;
  out.mask_field_ms = timings.mask_field_ms;
  out.model_ms = timings.model_ms;
  out.gate_ms = timings.gate_ms;
  out.total_ms = timings.total_ms;
  for (const LeftOut part : estimate.left_out) out.left_out |= 1U << static_cast<unsigned>(part);
  out.closed = estimate.closed ? 1 : 0;
  out.origin = static_cast<std::int32_t>(estimate.origin);
  return out;
}

flowdlo_crossing plain(const RopeCrossing& crossing) {
  return {.struct_size = 0,
          .over = crossing.over,
          .under = crossing.under,
          .over_at_m = crossing.over_at_m,
          .under_at_m = crossing.under_at_m,
          .apart_m = crossing.apart_m,
          .reserved = 0};
}

}  // namespace flowdlo::c_api
