#include "gate/candidate.hpp"

#include <algorithm>
#include <cmath>

namespace flowdlo::gate {
namespace {

constexpr double kDiameters = 4;  // distances beyond are all alike, in a logarithm's arms
constexpr double kMostBehind = 6;

double missing(float share, double most) {
  return std::min(1.0, (1 - static_cast<double>(share)) / most);
}

double some(double value, double most) { return std::clamp(value / most, 0.0, 1.0); }

// Of a length in rope radii, growing slower and slower.
double radii(float length_m, float radius_m) {
  if (!(radius_m > 0) || !std::isfinite(length_m)) return 1;
  return std::min(1.0, std::log1p(static_cast<double>(length_m / radius_m)) / kDiameters);
}

}  // namespace

std::array<double, kCandidateFeatures> candidate_features(const Candidate& candidate) {
  const TubeScore& tube = candidate.tube;
  const double predicted = candidate.draw >= 0 ? 1 : 0;
  const double moved = predicted * radii(candidate.moved_m, candidate.radius_m);
  const double sine = missing(tube.least_sine, 1);
  return {1,
          predicted,
          missing(tube.mask_recall, 0.05),
          missing(tube.mask_recall, 0.3),
          missing(tube.mask_precision, 0.1),
          missing(tube.mask_precision, 0.4),
          missing(tube.depth_agreement, 0.1),
          missing(tube.depth_agreement, 0.5),
          std::clamp(static_cast<double>(std::abs(tube.depth_bias)), 0.0, 1.0),
          missing(tube.crossing_agreement, 0.3),
          sine * sine,
          missing(tube.least_clearance, 1),
          some(std::log1p(static_cast<double>(tube.bending)), 4),
          some(static_cast<double>(tube.sharpest_bend), 1),
          some(candidate.behind, kMostBehind),
          some(static_cast<double>(candidate.longest_gap), 15),
          moved,
          moved * missing(candidate.supported, 1),
          predicted * radii(candidate.spread_m, candidate.radius_m),
          predicted * radii(candidate.sigma_m, candidate.radius_m)};
}

}  // namespace flowdlo::gate
