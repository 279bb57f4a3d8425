#include "gate/candidate_features.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "geometry/polyline.hpp"

namespace flowdlo::gate {
namespace {

constexpr double kApart = 2;       // diameters between candidates that run elsewhere
constexpr double kLogRadii = 4;    // distances in radii beyond exp of this are all alike
constexpr double kMostBehind = 6;  // path score
constexpr double kNear = 1.5;      // path score of a runner-up that is about as good
constexpr double kMostGap = 15;    // rope widths
constexpr double kClear = 3;       // score that settles it
constexpr double kCentimetre = 0.01;
constexpr double kMostLogit = 6;

double missing(float share, double most) {
  return std::clamp((1 - static_cast<double>(share)) / most, 0.0, 1.0);
}

double some(double value, double most) { return std::clamp(value / most, 0.0, 1.0); }

/// By how much `after` exceeds `before`, in [-1, 1].
double gained(float before, float after, double most) {
  return std::clamp((static_cast<double>(after) - static_cast<double>(before)) / most, -1.0, 1.0);
}

/// Of a length in rope radii, growing slower and slower.
double radii(double length_m, double radius_m) {
  if (!(radius_m > 0) || !std::isfinite(length_m)) return 1;
  return some(std::log1p(length_m / radius_m), kLogRadii);
}

/// Of a positive ratio, in [-1, 1].
double log_ratio(double value, double unit, double most) {
  if (!(value > 0) || !(unit > 0)) return 0;
  return std::clamp(std::log(value / unit) / most, -1.0, 1.0);
}

double mean(const std::array<float, kNodes>& values) {
  double sum = 0;
  for (const float value : values) sum += static_cast<double>(value) / kNodes;
  return sum;
}

double largest(const std::array<float, kNodes>& values) {
  return static_cast<double>(*std::max_element(values.begin(), values.end()));
}

double distance_m(const Point3& a, const Point3& b) {
  return std::hypot(static_cast<double>(a.x) - static_cast<double>(b.x),
                    static_cast<double>(a.y) - static_cast<double>(b.y),
                    static_cast<double>(a.z) - static_cast<double>(b.z));
}

double mean_distance_m(const Centerline& a, const Centerline& b) {
  double forward = 0;
  double backward = 0;
  for (std::size_t i = 0; i < kNodes; ++i) {
    forward += distance_m(a[i], b[i]) / kNodes;
    backward += distance_m(a[i], b[kNodes - 1 - i]) / kNodes;
  }
  return std::min(forward, backward);
}

/// The first draw of the same hypothesis; null where it has none.
const Candidate* draw_of(std::span<const Candidate> candidates, int hypothesis) {
  for (const Candidate& candidate : candidates) {
    if (candidate.draw >= 0 && candidate.hypothesis == hypothesis) return &candidate;
  }
  return nullptr;
}

/// The best prior of another hypothesis that runs elsewhere; null where there is none.
const Candidate* rival_of(std::span<const Candidate> candidates, const Candidate& candidate) {
  for (const Candidate& other : candidates) {
    if (other.draw >= 0 || other.hypothesis == candidate.hypothesis) continue;
    if (runs_elsewhere(candidate, other)) return &other;
  }
  return nullptr;
}

/// Between the nodes of that index, `b` turned the way that brings it nearer to `a` as a whole.
double node_distance_m(const Centerline& a, const Centerline& b, std::size_t node) {
  const double forward = distance_m(a.front(), b.front()) + distance_m(a.back(), b.back());
  const double backward = distance_m(a.front(), b.back()) + distance_m(a.back(), b.front());
  return distance_m(a[node], forward <= backward ? b[node] : b[kNodes - 1 - node]);
}

/// Half for every candidate of another hypothesis that ends up at the same place.
double agreed(std::span<const Candidate> candidates, const Candidate& candidate) {
  double others = 0;
  for (const Candidate& other : candidates) {
    if (other.hypothesis == candidate.hypothesis) continue;
    others += runs_elsewhere(candidate, other) ? 0 : 0.5;
  }
  return std::min(1.0, others);
}

template <std::size_t Size>
struct Row {
  std::array<double, Size> values{};
  std::size_t count = 0;

  void add(double value) {
    assert(count < Size);
    values[count++] = value;
  }
};

/// What mask, depth and path say of one candidate.
template <std::size_t Size>
void add_looks(const Candidate& candidate, Row<Size>& row) {
  const TubeScore& tube = candidate.tube;
  row.add(missing(tube.mask_recall, 0.05));
  row.add(missing(tube.mask_recall, 0.3));
  row.add(missing(tube.mask_precision, 0.1));
  row.add(missing(tube.mask_precision, 0.4));
  row.add(missing(tube.depth_agreement, 0.1));
  row.add(missing(tube.depth_agreement, 0.5));
  row.add(std::clamp(static_cast<double>(std::abs(tube.depth_bias)), 0.0, 1.0));
  row.add(missing(tube.crossing_agreement, 0.3));
  row.add(missing(tube.least_sine, 1) * missing(tube.least_sine, 1));
  row.add(missing(tube.least_clearance, 1));
  row.add(some(std::log1p(static_cast<double>(tube.bending)), 4));
  row.add(some(static_cast<double>(tube.sharpest_bend), 1));
  row.add(some(static_cast<double>(tube.overlap_share), 0.5));
  row.add(some(static_cast<double>(tube.hidden_share), 0.3));
  row.add(some(std::log1p(static_cast<double>(tube.crossings)), 3));
  row.add(some(static_cast<double>(candidate.longest_gap), kMostGap));
  row.add(some(static_cast<double>(candidate.bridged), 1));
  row.add(some(static_cast<double>(candidate.hidden_ends), 1));
  row.add(some(static_cast<double>(candidate.buried_ends), 1));
  row.add(some(static_cast<double>(candidate.ring), 1));
  row.add(missing(candidate.supported, 1));
  row.add(some(static_cast<double>(candidate.length_off), 0.5));
}

/// What the model says about the hypothesis, whether the candidate is its prior or a draw.
template <std::size_t Size>
void add_model(std::span<const Candidate> candidates, const Candidate& candidate, Row<Size>& row) {
  const Candidate* const draw = draw_of(candidates, candidate.hypothesis);
  const Candidate& prior = candidates[static_cast<std::size_t>(candidate.hypothesis)];
  const auto radius_m = static_cast<double>(candidate.radius_m);
  row.add(radii(mean(prior.sigma_m), radius_m));
  row.add(draw != nullptr ? radii(mean(draw->sigma_m), radius_m) : 0);
  row.add(draw != nullptr ? radii(mean_distance_m(draw->nodes, prior.nodes), radius_m) : 0);
  row.add(draw != nullptr ? 0 : 1);
}

double length_m(const Candidate& candidate) {
  return static_cast<double>(geometry::length(candidate.nodes));
}

}  // namespace

bool runs_elsewhere(const Candidate& a, const Candidate& b) {
  return !(mean_distance_m(a.nodes, b.nodes) <= 2 * kApart * static_cast<double>(a.radius_m));
}

std::array<double, kDrawFeatures> draw_features(std::span<const Candidate> candidates,
                                                std::size_t index) {
  const Candidate& draw = candidates[index];
  const Candidate& prior = candidates[static_cast<std::size_t>(draw.hypothesis)];
  const auto radius_m = static_cast<double>(draw.radius_m);
  const double moved_m = mean_distance_m(draw.nodes, prior.nodes);
  Row<kDrawFeatures> row;
  row.add(1);
  row.add(radii(moved_m, radius_m));
  row.add(radii(moved_m, mean(prior.sigma_m)));
  row.add(radii(mean(prior.sigma_m), radius_m));
  row.add(radii(mean(draw.sigma_m), radius_m));
  row.add(log_ratio(mean(draw.sigma_m), mean(prior.sigma_m), 3));
  row.add(log_ratio(length_m(draw), length_m(prior), 0.2));
  row.add(std::abs(log_ratio(length_m(draw), length_m(prior), 0.2)));
  row.add(some(draw.behind, kMostBehind));
  row.add(gained(prior.tube.mask_recall, draw.tube.mask_recall, 0.02));
  row.add(gained(prior.tube.mask_recall, draw.tube.mask_recall, 0.2));
  row.add(gained(prior.tube.mask_precision, draw.tube.mask_precision, 0.02));
  row.add(gained(prior.tube.mask_precision, draw.tube.mask_precision, 0.2));
  row.add(gained(prior.tube.depth_agreement, draw.tube.depth_agreement, 0.05));
  row.add(gained(prior.tube.depth_agreement, draw.tube.depth_agreement, 0.5));
  row.add(gained(std::abs(draw.tube.depth_bias), std::abs(prior.tube.depth_bias), 0.5));
  row.add(gained(prior.tube.crossing_agreement, draw.tube.crossing_agreement, 0.3));
  row.add(gained(draw.tube.crossings, prior.tube.crossings, 2));
  row.add(gained(draw.tube.bending, prior.tube.bending, 2));
  row.add(gained(draw.tube.sharpest_bend, prior.tube.sharpest_bend, 0.3));
  row.add(missing(draw.supported, 1));
  row.add(some(static_cast<double>(draw.longest_gap), kMostGap));
  row.add(some(static_cast<double>(draw.hidden_ends), 1));
  row.add(some(static_cast<double>(draw.buried_ends), 1));
  row.add(some(static_cast<double>(draw.ring), 1));
  row.add(gained(draw.length_off, prior.length_off, 0.1));
  return row.values;
}

std::array<double, kHypothesisFeatures> hypothesis_features(std::span<const Candidate> candidates,
                                                            std::size_t index) {
  const Candidate& candidate = candidates[index];
  Row<kHypothesisFeatures> row;
  row.add(some(candidate.behind, kMostBehind));
  row.add(some(candidate.behind, kNear));
  row.add(agreed(candidates, candidate));
  add_looks(candidate, row);
  add_model(candidates, candidate, row);
  return row.values;
}

std::array<double, kClosenessFeatures> closeness_features(std::span<const Candidate> candidates,
                                                          std::size_t index, double lead) {
  const Candidate& candidate = candidates[index];
  const Candidate& prior = candidates[static_cast<std::size_t>(candidate.hypothesis)];
  Row<kClosenessFeatures> row;
  row.add(1);
  row.add(some(lead, kClear));
  row.add(some(lead, kClear / 6));
  row.add(agreed(candidates, candidate));
  row.add(some(candidate.behind, kMostBehind));
  add_looks(candidate, row);
  add_model(candidates, candidate, row);
  row.add(candidate.draw >= 0 ? 1 : 0);
  row.add(log_ratio(mean(prior.sigma_m), kCentimetre, 4));
  row.add(log_ratio(largest(prior.sigma_m), kCentimetre, 4));
  row.add(log_ratio(mean(candidate.sigma_m), kCentimetre, 4));
  row.add(log_ratio(length_m(candidate), 1, 3));
  return row.values;
}

std::array<double, kSigmaFeatures> sigma_features(std::span<const Candidate> candidates,
                                                  std::size_t index, std::size_t node,
                                                  double probability) {
  const Candidate& candidate = candidates[index];
  const Candidate& prior = candidates[static_cast<std::size_t>(candidate.hypothesis)];
  const Candidate* const draw = draw_of(candidates, candidate.hypothesis);
  const Candidate& model = draw != nullptr ? *draw : prior;
  const double share = std::clamp(probability, 1e-3, 1 - 1e-3);
  const double logit = std::clamp(std::log(share / (1 - share)), -kMostLogit, kMostLogit);
  const double doubt = std::max(0.0, 2 - logit);
  const auto log_m = [](double value) { return std::log(std::max(1e-5, value) / 0.003); };
  const double own = log_m(static_cast<double>(prior.sigma_m[node]));
  const double middle = std::abs((static_cast<double>(node) + 0.5) / kNodes - 0.5);
  const Candidate* const rival = rival_of(candidates, candidate);
  const double apart =
      rival != nullptr ? log_m(node_distance_m(candidate.nodes, rival->nodes, node) + 1e-3) : 0;
  Row<kSigmaFeatures> row;
  row.add(1);
  row.add(own);
  row.add(log_m(mean(prior.sigma_m)));
  row.add(log_m(largest(prior.sigma_m)));
  row.add(draw != nullptr ? 0 : 1);
  row.add(log_m(static_cast<double>(model.sigma_m[node])) - own);
  row.add(log_m(mean(model.sigma_m)) - log_m(mean(prior.sigma_m)));
  row.add(draw != nullptr ? log_m(distance_m(prior.nodes[node], model.nodes[node]) + 1e-4) : 0);
  row.add(rival != nullptr ? 0 : 1);
  row.add(apart);
  row.add(apart * doubt);
  row.add(logit);
  row.add(doubt);
  row.add(std::max(0.0, -logit));
  row.add(std::max(0.0, 3.5 - logit));
  row.add(own * doubt);
  row.add(log_m(static_cast<double>(candidate.radius_m)));
  row.add(std::log(std::max(1e-3, length_m(candidate))));
  row.add(middle);
  row.add(middle * own);
  row.add(middle * doubt);
  row.add(missing(candidate.tube.depth_agreement, 0.5));
  row.add(missing(candidate.tube.mask_precision, 0.1));
  row.add(static_cast<double>(candidate.hidden_ends));
  row.add(static_cast<double>(candidate.buried_ends));
  return row.values;
}

}  // namespace flowdlo::gate
