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
constexpr double kMillimetre = 0.001;

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

double length_m(const Candidate& candidate) {
  return static_cast<double>(geometry::length(candidate.nodes));
}

/// Half for the prior of every other hypothesis that ends up at the same place.
double agreed(std::span<const Candidate> candidates, const Candidate& candidate) {
  double others = 0;
  for (const Candidate& other : candidates) {
    if (other.draw >= 0 || other.hypothesis == candidate.hypothesis) continue;
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

/// What the readings of the mask say of it.
template <std::size_t Size>
void add_readings(const Candidate& candidate, Row<Size>& row) {
  row.add(candidate.readings > 1 ? 1 : 0);
  row.add(candidate.reread ? 1 : 0);
  row.add(static_cast<double>(candidate.votes));
  row.add(static_cast<double>(candidate.odds));
}

/// By how much more of mask and depth `after` explains.
template <std::size_t Size>
void add_explained(const TubeScore& before, const TubeScore& after, Row<Size>& row) {
  row.add(gained(before.mask_recall, after.mask_recall, 0.02));
  row.add(gained(before.mask_recall, after.mask_recall, 0.2));
  row.add(gained(before.mask_precision, after.mask_precision, 0.02));
  row.add(gained(before.mask_precision, after.mask_precision, 0.2));
  row.add(gained(before.depth_agreement, after.depth_agreement, 0.05));
  row.add(gained(before.depth_agreement, after.depth_agreement, 0.5));
}

/// By how much more of what the strand field shows `after` agrees with.
template <std::size_t Size>
void add_agreed(const AxesScore& before, const AxesScore& after, Row<Size>& row) {
  row.add(gained(before.followed, after.followed, 0.02));
  row.add(gained(before.followed, after.followed, 0.2));
  row.add(gained(before.backed, after.backed, 0.02));
  row.add(gained(before.backed, after.backed, 0.2));
  row.add(gained(before.tips_met, after.tips_met, 1));
  row.add(gained(after.tips_left, before.tips_left, 1));
}

/// How well it agrees with what the strand field shows.
template <std::size_t Size>
void add_seen(const Candidate& candidate, Row<Size>& row) {
  const AxesScore& axes = candidate.axes;
  const double known = axes.known ? 1 : 0;
  row.add(static_cast<double>(candidate.seen_odds));
  row.add(known * missing(axes.followed, 0.05));
  row.add(known * missing(axes.followed, 0.4));
  row.add(known * missing(axes.backed, 0.1));
  row.add(known * missing(axes.backed, 0.5));
  row.add(some(static_cast<double>(axes.twice), 0.2));
  row.add(known * missing(axes.tips_met, 1));
  row.add(some(static_cast<double>(axes.tips_left), 1));
}

/// By how much it looks better, or only different, than another.
template <std::size_t Size>
void add_gains(const Candidate& before, const Candidate& after, Row<Size>& row) {
  add_explained(before.tube, after.tube, row);
  row.add(gained(before.tube.crossing_agreement, after.tube.crossing_agreement, 0.3));
  row.add(gained(after.tube.bending, before.tube.bending, 2));
  row.add(gained(after.tube.overlap_share, before.tube.overlap_share, 0.3));
  row.add(gained(after.longest_gap, before.longest_gap, kMostGap));
  row.add(log_ratio(length_m(after), length_m(before), 0.5));
  row.add(std::abs(log_ratio(length_m(after), length_m(before), 0.5)));
}

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

}  // namespace

bool runs_elsewhere(const Candidate& a, const Candidate& b) {
  return !(geometry::mean_distance(a.nodes, b.nodes) <=
           2 * kApart * static_cast<double>(a.radius_m));
}

std::array<double, kDrawFeatures> draw_features(std::span<const Candidate> candidates,
                                                std::size_t index) {
  const Candidate& draw = candidates[index];
  const Candidate& prior = candidates[static_cast<std::size_t>(draw.hypothesis)];
  const auto radius_m = static_cast<double>(draw.radius_m);
  const double moved_m = geometry::mean_distance(draw.nodes, prior.nodes);
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
  add_explained(prior.tube, draw.tube, row);
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
  const Candidate& prior = candidates[static_cast<std::size_t>(candidate.hypothesis)];
  Row<kHypothesisFeatures> row;
  row.add(1);
  row.add(std::clamp(candidate.behind / kMostBehind, -1.0, 1.0));
  row.add(std::clamp(candidate.behind / kNear, -1.0, 1.0));
  add_readings(candidate, row);
  row.add(agreed(candidates, candidate));
  add_gains(candidates.front(), candidate, row);
  add_looks(candidate, row);
  row.add(radii(mean(prior.sigma_m), static_cast<double>(candidate.radius_m)));
  add_agreed(candidates.front().axes, candidate.axes, row);
  add_seen(candidate, row);
  return row.values;
}

std::array<double, kClosenessFeatures> closeness_features(std::span<const Candidate> candidates,
                                                          std::size_t index, double lead) {
  const Candidate& candidate = candidates[index];
  const Candidate& prior = candidates[static_cast<std::size_t>(candidate.hypothesis)];
  const auto radius_m = static_cast<double>(candidate.radius_m);
  const auto hypotheses = static_cast<double>(std::count_if(
      candidates.begin(), candidates.end(), [](const Candidate& other) { return other.draw < 0; }));
  Row<kClosenessFeatures> row;
  row.add(1);
  row.add(some(lead, kClear));
  row.add(some(lead, kClear / 6));
  row.add(agreed(candidates, candidate));
  row.add(some(candidate.behind, kMostBehind));
  add_readings(candidate, row);
  add_looks(candidate, row);
  row.add(radii(mean(prior.sigma_m), radius_m));
  row.add(log_ratio(mean(prior.sigma_m), kCentimetre, 4));
  row.add(log_ratio(largest(prior.sigma_m), kCentimetre, 4));
  row.add(log_ratio(length_m(candidate), 1, 3));
  row.add(log_ratio(static_cast<double>(candidate.pixel_m), kMillimetre, 3));
  row.add(log_ratio(static_cast<double>(candidate.noise_m) + 0.1 * kMillimetre, kMillimetre, 3));
  row.add(radii(largest(candidate.unseen_m), radius_m));
  row.add(hypotheses / 4);
  add_seen(candidate, row);
  return row.values;
}

}  // namespace flowdlo::gate
