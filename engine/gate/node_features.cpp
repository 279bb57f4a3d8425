#include "gate/node_features.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "gate/candidate_features.hpp"
#include "geometry/camera.hpp"
#include "geometry/polyline.hpp"

namespace flowdlo::gate {
namespace {

constexpr double kUnit_m = 0.003;
constexpr double kLeastSigma_m = 1e-5;
constexpr double kLeastApart_m = 5e-4;
constexpr double kLeastNoise_m = 1e-4;
constexpr double kLeastUnseen_m = 1e-3;
constexpr double kMost_m = 100;
constexpr double kMostLogit = 6;
constexpr double kSure = 2;          // logit above which there is no doubt to speak of
constexpr std::size_t kOfNode = 10;  // features that differ from node to node, after the first
constexpr double kLeastSine = 0.1;

double log_m(double length_m, double least_m) {
  if (!std::isfinite(length_m)) return std::log(kMost_m / kUnit_m);
  return std::log(std::clamp(length_m, least_m, kMost_m) / kUnit_m);
}

/// [64] between nodes of the same index, `b` turned the way that brings it nearer as a whole.
std::array<double, kNodes> distances_m(const Centerline& a, const Centerline& b) {
  std::array<double, kNodes> forward{};
  std::array<double, kNodes> backward{};
  double balance = 0;
  for (std::size_t i = 0; i < kNodes; ++i) {
    forward[i] = geometry::distance(a[i], b[i]);
    backward[i] = geometry::distance(a[i], b[kNodes - 1 - i]);
    balance += forward[i] - backward[i];
  }
  return balance <= 0 ? forward : backward;
}

/// Of each, by softmax of the scores.
std::vector<double> odds(std::span<const double> scores) {
  std::vector<double> result;
  const double most = *std::max_element(scores.begin(), scores.end());
  double sum = 0;
  for (const double score : scores) sum += result.emplace_back(std::exp(score - most));
  for (double& value : result) value /= sum;
  return result;
}

/// Of the angle between the ray through a node and the rope there.
double sine(const Centerline& nodes, std::size_t node) {
  const Eigen::Vector3f ray = geometry::to_eigen(nodes[node]);
  const Eigen::Vector3f along =
      geometry::to_eigen(nodes[std::min<std::size_t>(node + 1, kNodes - 1)]) -
      geometry::to_eigen(nodes[node > 0 ? node - 1 : 0]);
  const float value = along.cross(ray).norm() / (along.norm() * ray.norm());
  return std::isfinite(value) ? static_cast<double>(value) : 1;
}

double mean(const std::array<double, kNodes>& values) {
  double sum = 0;
  for (const double value : values) sum += value / kNodes;
  return sum;
}

double largest(const std::array<double, kNodes>& values) {
  return *std::max_element(values.begin(), values.end());
}

}  // namespace

NodeFeatures::NodeFeatures(std::span<const Candidate> candidates,
                           std::span<const std::size_t> returned, std::span<const double> scores,
                           std::size_t chosen, double probability)
    : candidate_(candidates[returned[chosen]]) {
  const Candidate& prior = candidates[static_cast<std::size_t>(candidate_.hypothesis)];
  for (std::size_t i = 0; i < kNodes; ++i) sigma_m_[i] = static_cast<double>(prior.sigma_m[i]);
  measure_rivals(candidates, returned, scores, chosen);
  describe_frame(prior, probability);
}

void NodeFeatures::measure_rivals(std::span<const Candidate> candidates,
                                  std::span<const std::size_t> returned,
                                  std::span<const double> scores, std::size_t chosen) {
  const std::vector<double> share = odds(scores);
  rivals_odds_ = 1 - share[chosen];
  alone_ = returned.size() < 2;
  std::array<double, kNodes> square{};
  std::array<double, kNodes> voted{};
  for (std::size_t h = 0; h < returned.size(); ++h) {
    if (h == chosen) continue;
    const Candidate& rival = candidates[returned[h]];
    const auto apart_m = distances_m(candidate_.nodes, rival.nodes);
    for (std::size_t i = 0; i < kNodes; ++i) {
      square[i] += share[h] * apart_m[i] * apart_m[i];
      voted[i] += static_cast<double>(rival.odds) * apart_m[i] * apart_m[i];
      furthest_m_[i] = std::max(furthest_m_[i], apart_m[i]);
    }
  }
  for (std::size_t i = 0; i < kNodes; ++i) {
    spread_m_[i] = std::sqrt(square[i]);
    voted_m_[i] = std::sqrt(voted[i]);
  }
}

void NodeFeatures::describe_frame(const Candidate& prior, double probability) {
  const double share = std::clamp(probability, 1e-3, 1 - 1e-3);
  const double logit = std::clamp(std::log(share / (1 - share)), -kMostLogit, kMostLogit);
  double unseen = 0;
  double most_unseen_m = 0;
  for (const float unseen_m : candidate_.unseen_m) {
    unseen += unseen_m > 0 ? 1.0 / kNodes : 0;
    most_unseen_m = std::max(most_unseen_m, static_cast<double>(unseen_m));
  }
  const TubeScore& tube = candidate_.tube;
  std::size_t next = 1 + kOfNode;
  const auto add = [&](double value) { frame_[next++] = value; };
  frame_[0] = 1;
  add(log_m(mean(sigma_m_), kLeastSigma_m));
  add(log_m(largest(sigma_m_), kLeastSigma_m));
  add(alone_ ? 1 : 0);
  add(log_m(mean(spread_m_), kLeastApart_m));
  add(log_m(mean(furthest_m_), kLeastApart_m));
  add(rivals_odds_);
  add(candidate_.readings > 1 ? 1 : 0);
  add(static_cast<double>(candidate_.votes));
  add(static_cast<double>(candidate_.odds));
  add(logit);
  add(std::max(0.0, kSure - logit));
  add(log_m(static_cast<double>(candidate_.radius_m), kLeastSigma_m));
  add(log_m(static_cast<double>(geometry::length(candidate_.nodes)), kLeastSigma_m));
  add(log_m(static_cast<double>(candidate_.pixel_m), kLeastSigma_m));
  add(log_m(static_cast<double>(candidate_.noise_m), kLeastNoise_m));
  add(unseen);
  add(log_m(most_unseen_m, kLeastUnseen_m));
  add(missing(prior.supported, 1));
  add(missing(tube.depth_agreement, 0.5));
  add(missing(tube.mask_precision, 0.1));
  add(missing(tube.mask_recall, 0.05));
  add(missing(tube.mask_recall, 0.3));
  add(static_cast<double>(tube.hidden_share));
  add(std::log1p(static_cast<double>(tube.crossings)));
  add(static_cast<double>(candidate_.hidden_ends));
  add(static_cast<double>(candidate_.buried_ends));
  add(static_cast<double>(candidate_.ring));
  add(std::clamp(static_cast<double>(candidate_.length_off) / 0.5, 0.0, 1.0));
}

std::array<double, kNodeFeatures> NodeFeatures::of(std::size_t node) const {
  std::array<double, kNodeFeatures> row = frame_;
  const double own = log_m(sigma_m_[node], kLeastSigma_m);
  const double middle = std::abs((static_cast<double>(node) + 0.5) / kNodes - 0.5);
  row[1] = own;
  row[2] = log_m(spread_m_[node], kLeastApart_m);
  row[3] = log_m(furthest_m_[node], kLeastApart_m);
  row[4] = log_m(static_cast<double>(candidate_.unseen_m[node]), kLeastUnseen_m);
  row[5] = middle;
  row[6] = middle * own;
  row[7] = log_m(voted_m_[node], kLeastApart_m);
  const bool before = node < kNodes / 2;
  row[8] = log_m(before ? sigma_m_.front() : sigma_m_.back(), kLeastSigma_m);
  row[9] = log_m(before ? sigma_m_.back() : sigma_m_.front(), kLeastSigma_m);
  row[10] = -std::log(std::max(sine(candidate_.nodes, node), kLeastSine));
  return row;
}

}  // namespace flowdlo::gate
