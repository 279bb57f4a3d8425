// The fit of the calibrated gate, on scenes made by hand.
#include "gate_fit/fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace flowdlo::lab {
namespace {

gate::Candidate line(double shift_m, int hypothesis, int draw, double recall) {
  gate::Candidate candidate;
  for (std::size_t i = 0; i < kNodes; ++i) {
    candidate.nodes[i] = {0.005F * static_cast<float>(i), static_cast<float>(shift_m), 0.5F};
  }
  candidate.sigma_m.fill(0.002F);
  candidate.hypothesis = hypothesis;
  candidate.draw = draw;
  candidate.radius_m = 0.003F;
  candidate.supported = 1;
  candidate.tube.mask_recall = static_cast<float>(recall);
  candidate.tube.mask_precision = 1;
  candidate.tube.depth_agreement = 1;
  candidate.tube.bending = 0.1F;
  return candidate;
}

/// The truth is a line at 0. In every second scene the runner-up is the one that lies on it and
/// explains the mask; the draw is always 2 mm worse than its prior.
std::vector<GateSample> scenes(int count) {
  std::vector<GateSample> samples;
  for (int i = 0; i < count; ++i) {
    GateSample sample;
    sample.truth = line(0, 0, -1, 1).nodes;
    const bool swapped = i % 2 == 0;
    const double noise_m = 0.0005 * (1 + i % 7);
    sample.candidates = {line(swapped ? 0.08 : noise_m, 0, -1, swapped ? 0.7 : 1),
                         line(swapped ? noise_m : 0.08, 1, -1, swapped ? 1 : 0.7),
                         line((swapped ? 0.08 : noise_m) + 0.002, 0, 0, swapped ? 0.7 : 1)};
    samples.push_back(sample);
  }
  return samples;
}

TEST(FitGate, FindsTheHypothesisThatExplainsTheMaskAndLeavesBadDrawsAlone) {
  const auto weights = fit_gate(scenes(60)).weights;
  for (const GateSample& sample : scenes(60)) {
    const auto errors = errors_m(sample);
    const auto choice = gate::choose_calibrated(sample.candidates, weights);
    EXPECT_LT(errors[choice.chosen], 0.005);
    EXPECT_LT(sample.candidates[choice.chosen].draw, 0);
  }
}

TEST(FitGate, ChangesNothingWhereNoRunnerUpIsEverBetter) {
  auto samples = scenes(60);
  std::erase_if(samples, [](const GateSample& sample) {
    return sample.candidates.front().tube.mask_recall < 1;
  });
  const auto weights = fit_gate(samples).weights;
  for (const GateSample& sample : samples) {
    EXPECT_EQ(gate::choose_calibrated(sample.candidates, weights).chosen, 0U);
  }
}

TEST(FitGate, SaysHowOftenItIsClose) {
  const auto weights = fit_gate(scenes(60)).weights;
  double mean = 0;
  for (const GateSample& sample : scenes(60)) {
    mean += gate::choose_calibrated(sample.candidates, weights).probability / 60;
  }
  EXPECT_GT(mean, 0.9);  // all of them are
}

/// One hypothesis, every node off by its own normal deviate of 1 mm.
std::vector<GateSample> noisy_scenes(int count) {
  std::mt19937 engine(5);
  std::normal_distribution<float> noise_m(0, 0.001F);
  std::vector<GateSample> samples;
  for (int i = 0; i < count; ++i) {
    GateSample sample;
    sample.truth = line(0, 0, -1, 1).nodes;
    sample.candidates = {line(0, 0, -1, 1)};
    for (Point3& node : sample.candidates[0].nodes) node.y += noise_m(engine);
    samples.push_back(sample);
  }
  return samples;
}

TEST(FitGate, CoversAboutTwoThirdsOfTheNodesByOneSigmaAndNearlyAllByTwo) {
  const auto samples = noisy_scenes(200);
  const auto weights = fit_gate(samples).weights;
  double one = 0;
  double two = 0;
  for (const GateSample& sample : samples) {
    const auto choice = gate::choose_calibrated(sample.candidates, weights);
    const auto off_m = node_errors_m(sample.candidates[0].nodes, sample.truth);
    for (std::size_t node = 0; node < kNodes; ++node) {
      const auto sigma_m = static_cast<double>(choice.sigma_m[node]);
      one += off_m[node] <= sigma_m ? 1.0 / (200 * kNodes) : 0;
      two += off_m[node] <= 2 * sigma_m ? 1.0 / (200 * kNodes) : 0;
    }
  }
  EXPECT_NEAR(one, 0.68, 0.05);
  EXPECT_NEAR(two, 0.95, 0.05);
}

TEST(ErrorsOf, ARopeWalkedBackwardsAreNone) {
  GateSample sample;
  sample.candidates = {line(0, 0, -1, 1)};
  sample.truth = sample.candidates[0].nodes;
  std::reverse(sample.truth.begin(), sample.truth.end());
  EXPECT_NEAR(errors_m(sample)[0], 0, 1e-9);
}

}  // namespace
}  // namespace flowdlo::lab
