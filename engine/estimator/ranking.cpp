#include "estimator/ranking.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace flowdlo::estimator {
namespace {

constexpr double kMarginScore = 3.0;  // the lead that leaves a third of the doubt
// In the order of `penalties`, in units of path score. Fitted on synthetic scenes by
// `flowdlo-lab scenes fit --scenes 130 --wide 1400`; sharp bends speak against none there.
constexpr std::array<double, kPenalties> kPenaltyWeights{11.94, 1.88, 6.52, 5.65, 7.34, 0.0};

void measure_path(const path::Path& path, float rope_width_px, Evidence& evidence) {
  const float width_px = std::max(1.0F, rope_width_px);
  float length_px = 0;
  float bridged_px = 0;
  float gap_px = 0;
  float longest_px = 0;
  for (std::size_t i = 1; i < path.points_px.size(); ++i) {
    const float step = (path.points_px[i] - path.points_px[i - 1]).norm();
    const bool bridged = path.bridged[i] != 0 || path.bridged[i - 1] != 0;
    length_px += step;
    gap_px = bridged ? gap_px + step : 0;
    bridged_px += bridged ? step : 0;
    longest_px = std::max(longest_px, gap_px);
  }
  evidence.bridged = length_px > 0 ? std::min(1.0F, bridged_px / length_px) : 1;
  evidence.longest_gap = std::min(99.0F, longest_px / width_px);
  evidence.length_widths = std::min(999.0F, length_px / width_px);
}

}  // namespace

Evidence judge(const path::Path& path, float rope_width_px, const prior::Prior* refined,
               gate::TubeView& view) {
  Evidence evidence;
  measure_path(path, rope_width_px, evidence);
  evidence.hidden_ends = path.hidden_ends;
  evidence.buried_ends = path.buried_ends;
  evidence.ring = path.ring;
  evidence.closed = path.closed;
  if (refined == nullptr) return evidence;
  evidence.tube = view.score(refined->nodes, view.radius_m(refined->nodes));
  const auto supported =
      std::count(refined->support.begin(), refined->support.end(), std::uint8_t{1});
  evidence.supported = static_cast<float>(supported) / static_cast<float>(kNodes);
  return evidence;
}

std::array<double, kPenalties> penalties(const Evidence& evidence) {
  const gate::TubeScore& tube = evidence.tube;
  const auto missing = [](float share) { return 1 - static_cast<double>(share); };
  return {missing(tube.mask_recall),
          missing(tube.mask_precision),
          missing(tube.depth_agreement),
          missing(tube.crossing_agreement),
          std::log1p(static_cast<double>(tube.bending)),
          static_cast<double>(tube.sharpest_bend)};
}

double rescored(double path_score, const Evidence& evidence) {
  const auto penalty = penalties(evidence);
  double score = path_score;
  for (std::size_t i = 0; i < kPenalties; ++i) score -= kPenaltyWeights[i] * penalty[i];
  return score;
}

float margin(double lead) {
  return static_cast<float>(1 - std::exp(-std::max(0.0, lead) / kMarginScore));
}

}  // namespace flowdlo::estimator
