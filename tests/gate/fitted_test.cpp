// The calibrated gate's numbers, to and from the section of a weights file.
#include "gate/fitted.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "weights/calibration.hpp"

namespace flowdlo::gate {
namespace {

/// Numbers that f32 holds exactly, each another one.
GateWeights counted() {
  GateWeights weights;
  double next = 0;
  const auto fill = [&](auto& row) {
    for (double& number : row) number = (next += 0.25);
  };
  const auto fill_network = [&](auto& network) {
    for (auto& row : network.hidden) fill(row);
    for (auto& row : network.bent) fill(row);
    for (auto& row : network.straight) fill(row);
  };
  fill(weights.draw);
  fill_network(weights.hypothesis);
  fill_network(weights.closeness);
  fill_network(weights.node_error);
  weights.draw_margin = -1;
  weights.hypothesis_margin = -2;
  weights.sigma_share = -3;
  return weights;
}

template <class Network>
void expect_same(const Network& a, const Network& b) {
  EXPECT_EQ(a.hidden, b.hidden);
  EXPECT_EQ(a.bent, b.bent);
  EXPECT_EQ(a.straight, b.straight);
}

TEST(Fitted, NumbersComeBackFromASectionAsTheyWere) {
  const GateWeights want = counted();
  const auto section = calibration_of(want, "of a test");
  EXPECT_EQ(section.notes, "of a test");
  const auto manifest = weights::calibration_manifest();
  ASSERT_EQ(section.tensors.size(), manifest.size());
  for (std::size_t i = 0; i < manifest.size(); ++i) {
    EXPECT_EQ(section.tensors[i].name, manifest[i].name);
    EXPECT_EQ(section.tensors[i].shape, manifest[i].shape);
  }
  const GateWeights got = gate_weights(section);
  EXPECT_EQ(got.draw, want.draw);
  EXPECT_EQ(got.draw_margin, -1);
  EXPECT_EQ(got.hypothesis_margin, -2);
  EXPECT_EQ(got.sigma_share, -3);
  expect_same(got.hypothesis, want.hypothesis);
  expect_same(got.closeness, want.closeness);
  expect_same(got.node_error, want.node_error);
}

TEST(Fitted, FramesThatAFieldSawHaveWeightsOfTheirOwnWhereItBringsThem) {
  Fitted fitted;
  std::vector<Candidate> candidates(2);
  EXPECT_EQ(&fitted.of(candidates), &fitted.to_mask);
  for (Candidate& candidate : candidates) candidate.axes.known = true;
  EXPECT_EQ(&fitted.of(candidates), &fitted.to_mask);
  fitted.to_field.emplace();
  EXPECT_EQ(&fitted.of(candidates), &*fitted.to_field);
}

}  // namespace
}  // namespace flowdlo::gate
