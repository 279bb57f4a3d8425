// The fit of the calibrated gate, on scenes made by hand.
#include "gate_fit/fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>

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
  const auto weights = fit_gate(scenes(60));
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
  const auto weights = fit_gate(samples);
  for (const GateSample& sample : samples) {
    EXPECT_EQ(gate::choose_calibrated(sample.candidates, weights).chosen, 0U);
  }
}

TEST(FitGate, SaysHowOftenItIsClose) {
  const auto weights = fit_gate(scenes(60));
  double mean = 0;
  for (const GateSample& sample : scenes(60)) {
    mean += gate::choose_calibrated(sample.candidates, weights).probability / 60;
  }
  EXPECT_GT(mean, 0.9);  // all of them are
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
