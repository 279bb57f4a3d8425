// Sec. 3.6: plausibility check and fallback, Eq. (3.30)-(3.33).
#include "gate/gate.hpp"

#include <algorithm>
#include <cassert>
#include <limits>
#include <numeric>

#include "geometry/polyline.hpp"

namespace flowdlo::gate {
namespace {

/// A figure of a report is finite whatever the draw: overflow becomes the largest float.
float finite(double value) {
  return static_cast<float>(
      std::min(value, static_cast<double>(std::numeric_limits<float>::max())));
}

/// Both ratios of Eq. (3.31). Where a curve has no length they are undefined: the report then holds
/// values that fail, a length ratio of 0 and a segment share of 1.
void measure_lengths(const Centerline& prediction, const Centerline& prior, DrawReport& report) {
  const auto segments = geometry::segment_lengths(prediction);  // d_i, Eq. (3.30)
  const double length_m = std::accumulate(segments.begin(), segments.end(), 0.0);
  const auto prior_segments = geometry::segment_lengths(prior);
  const double prior_length_m = std::accumulate(prior_segments.begin(), prior_segments.end(), 0.0);
  const double longest_m = *std::max_element(segments.begin(), segments.end());
  report.length_ratio = prior_length_m > 0 ? finite(length_m / prior_length_m) : 0;  // Eq. (3.31)
  report.max_segment_share = length_m > 0 ? finite(longest_m / length_m) : 1;        // Eq. (3.31)
}

DrawReport judge(const Centerline& prediction, const Centerline& prior, const DilatedMask& mask,
                 const Intrinsics& camera, const Limits& limits) {
  DrawReport report;
  report.finite = geometry::all_finite(prediction);
  if (!report.finite) return report;
  report.mask_agreement = mask.agreement(prediction, camera);
  if (!geometry::all_finite(prior)) return report;
  measure_lengths(prediction, prior, report);
  const bool plausible_shape = report.length_ratio >= limits.min_length_ratio &&
                               report.length_ratio <= limits.max_length_ratio &&
                               report.max_segment_share <= limits.max_segment_share;  // Eq. (3.31)
  const bool on_mask = report.mask_agreement >=
                       mask.agreement(prior, camera) - limits.mask_agreement_slack;  // Eq. (3.32)
  report.accepted = plausible_shape && on_mask;
  return report;
}

}  // namespace

Verdict choose(std::span<const Centerline> predictions, std::span<const Centerline> priors,
               const Centerline& fallback_prior, const DilatedMask& mask, const Intrinsics& camera,
               const Limits& limits) {
  assert(predictions.size() == priors.size());
  Verdict verdict;
  verdict.prior_agreement = mask.agreement(fallback_prior, camera);
  float best_agreement = -1;
  for (std::size_t d = 0; d < predictions.size(); ++d) {
    const DrawReport report = judge(predictions[d], priors[d], mask, camera, limits);
    verdict.draws.push_back(report);
    if (!report.accepted || report.mask_agreement <= best_agreement) continue;
    best_agreement = report.mask_agreement;
    verdict.source = Source::kPrediction;  // Eq. (3.33)
    verdict.draw = static_cast<int>(d);
  }
  return verdict;
}

}  // namespace flowdlo::gate
