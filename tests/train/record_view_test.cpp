// Turning a record: everything turns together, and the features are those of the turned frame.
#include "train/record_view.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "evidence/mask_field.hpp"
#include "reference/mask_features.hpp"
#include "support/program_cases.hpp"
#include "train/golden.hpp"
#include "train/sample_plan.hpp"

namespace flowdlo::train {
namespace {

using weights::NormalizationKind;

constexpr ViewConfig kFrameNorm{NormalizationKind::kFrame, {}, TruthDirection::kPrior};

/// Square pixels, the principal point in the middle, and scattered specks for a mask: beside a
/// rope's straight border many pixels have two nearest ones.
Record square_record() {
  Record record = golden_record();
  constexpr std::uint16_t kPlaces[][2] = {{4, 10},  {8, 62},  {14, 84}, {20, 36}, {28, 6},
                                          {34, 54}, {42, 74}, {50, 22}, {58, 44}, {66, 90}};
  record.mask.runs.clear();
  for (const auto& [v, u] : kPlaces) {
    record.mask.runs.push_back({v, u, 2});
    record.mask.runs.push_back({static_cast<std::uint16_t>(v + 1), u, 2});
  }
  record.camera = {.fx = 90, .fy = 90, .cx = 47.5F, .cy = 35.5F};
  return record;
}

/// States around the prior, [64, 4] normalised.
std::vector<float> states_near(const RecordView& view) {
  std::vector<float> state(view.prior().begin(), view.prior().end());
  const auto noise = testing::noise(state.size(), 3, 0.3F);
  for (std::size_t i = 0; i < state.size(); ++i) state[i] = i % 4 == 3 ? 0 : state[i] + noise[i];
  return state;
}

/// phi_M from the engine's own field of `mask`, at `state` under `norm`.
std::vector<float> engine_features(const Record& record, const std::vector<std::uint8_t>& mask,
                                   const Intrinsics& camera, std::span<const float> norm,
                                   std::span<const float> state) {
  const auto field =
      evidence::mask_field({record.mask.width, record.mask.height, {}, {}, mask, {}});
  ops::FrameParams params{};
  params.fx = camera.fx;
  params.fy = camera.fy;
  params.cx = camera.cx;
  params.cy = camera.cy;
  params.width = static_cast<float>(record.mask.width);
  params.height = static_cast<float>(record.mask.height);
  params.field_width = static_cast<float>(field.width);
  params.field_height = static_cast<float>(field.height);
  std::vector<float> features(kNodes * kFeatureColumns);
  reference::mask_features(state, norm, params, field.texels, {}, features);
  return features;
}

TEST(RecordView, UnturnedFeaturesAreTheEngines) {
  Record record = golden_record();
  record.depth_m.clear();
  const RecordView view(record, 0, {}, kFrameNorm);
  const auto state = states_near(view);
  std::vector<float> got(kNodes * kFeatureColumns);
  view.features(state, got);
  const auto want =
      engine_features(record, image_of(record.mask), record.camera, view.norm(), state);
  for (std::size_t i = 0; i < got.size(); ++i) {
    if (i % kFeatureColumns == 1) {
      ASSERT_NEAR(got[i], want[i], 1e-6) << i;
    } else {
      ASSERT_EQ(got[i], want[i]) << i;
    }
  }
}

/// The view's features against the engine's on an image that was itself turned. Where two mask
/// pixels are equally near, the turned image may name the other one: few displacements differ.
void expect_features_of_the_turned_image(const Turn& turn, bool flip_u, bool flip_v) {
  Record record = square_record();
  record.depth_m.clear();
  const RecordView view(record, 0, turn, kFrameNorm);
  const auto state = states_near(view);
  std::vector<float> got(kNodes * kFeatureColumns);
  view.features(state, got);

  const auto mask = image_of(record.mask);
  std::vector<std::uint8_t> turned(mask.size());
  const int width = record.mask.width;
  const int height = record.mask.height;
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u < width; ++u) {
      const int from_u = flip_u ? width - 1 - u : u;
      const int from_v = flip_v ? height - 1 - v : v;
      turned[static_cast<std::size_t>(v * width + u)] =
          mask[static_cast<std::size_t>(from_v * width + from_u)];
    }
  }
  const auto want = engine_features(record, turned, record.camera, view.norm(), state);
  int different = 0;
  for (std::size_t node = 0; node < kNodes; ++node) {
    const float* a = got.data() + node * kFeatureColumns;
    const float* b = want.data() + node * kFeatureColumns;
    EXPECT_NEAR(a[0], b[0], 1e-4) << node;
    EXPECT_NEAR(a[1], b[1], 1e-4) << node;
    EXPECT_EQ(a[5], b[5]) << node;
    if (std::abs(a[3] - b[3]) > 1e-3F || std::abs(a[4] - b[4]) > 1e-3F) ++different;
  }
  EXPECT_LE(different, 3);
}

TEST(RecordView, HalfATurnGivesTheFeaturesOfTheTurnedImage) {
  expect_features_of_the_turned_image({std::numbers::pi, false}, true, true);
}

TEST(RecordView, MirrorGivesTheFeaturesOfTheMirroredImage) {
  expect_features_of_the_turned_image({0, true}, true, false);
}

TEST(RecordView, AnyTurnKeepsDistancesAndTurnsDisplacements) {
  Record record = square_record();
  record.depth_m.clear();
  const Turn turn{1.1, true};
  const RecordView plain(record, 0, {}, kFrameNorm);
  const RecordView turned(record, 0, turn, kFrameNorm);
  const Eigen::Matrix2f matrix = turn.matrix();
  const auto state = states_near(plain);
  auto turned_state = state;
  for (std::size_t node = 0; node < kNodes; ++node) {
    const Eigen::Vector2f xy =
        matrix * Eigen::Vector2f(state[node * 4] * plain.norm()[3] + plain.norm()[0],
                                 state[node * 4 + 1] * plain.norm()[3] + plain.norm()[1]);
    turned_state[node * 4] = (xy.x() - turned.norm()[0]) / turned.norm()[3];
    turned_state[node * 4 + 1] = (xy.y() - turned.norm()[1]) / turned.norm()[3];
  }
  EXPECT_NEAR(plain.norm()[3], turned.norm()[3], 1e-6);
  std::vector<float> a(kNodes * kFeatureColumns);
  std::vector<float> b(kNodes * kFeatureColumns);
  plain.features(state, a);
  turned.features(turned_state, b);
  for (std::size_t node = 0; node < kNodes; ++node) {
    const float* before = a.data() + node * kFeatureColumns;
    const float* after = b.data() + node * kFeatureColumns;
    for (const std::size_t channel : {0, 1, 2, 5}) {
      EXPECT_NEAR(after[channel], before[channel], 2e-3) << node << " channel " << channel;
    }
    const Eigen::Vector2f displacement = matrix * Eigen::Vector2f(before[3], before[4]);
    EXPECT_NEAR(after[3], displacement.x(), 2e-3) << node;
    EXPECT_NEAR(after[4], displacement.y(), 2e-3) << node;
  }
}

TEST(RecordView, TurnedPriorIsCanonicalAndTruthFollowsIt) {
  const Record record = golden_record();
  const RecordView view(record, 0, {std::numbers::pi, false}, kFrameNorm);
  const auto prior = view.prior();
  const auto truth = view.truth();
  EXPECT_LT(prior[0], prior[(kNodes - 1) * 4]);
  double error = 0;
  for (std::size_t node = 0; node < kNodes; ++node) {
    error +=
        std::hypot(prior[node * 4] - truth[node * 4], prior[node * 4 + 1] - truth[node * 4 + 1]);
  }
  EXPECT_LT(error / kNodes, 0.2);
  // Reversed with its nodes: node 3 was the first without support.
  EXPECT_EQ(prior[(kNodes - 1 - 3) * 4 + 3], 0);
}

TEST(RecordView, GlobalNormIsMeanAndRootMeanSquareOfAllTruth) {  // Eq. (3.8), (3.9)
  std::vector<Record> records(2);
  for (auto& node : records[0].truth) node = {1, 2, 3};
  for (auto& node : records[1].truth) node = {3, 2, 3};
  const GlobalNorm norm = global_norm(records);
  EXPECT_FLOAT_EQ(norm.mean[0], 2);
  EXPECT_FLOAT_EQ(norm.mean[1], 2);
  EXPECT_FLOAT_EQ(norm.mean[2], 3);
  EXPECT_FLOAT_EQ(norm.scale, 1);
}

TEST(SamplePlan, IntersectionsComeTwiceAsOften) {  // Sec. 4.1.3
  std::vector<Record> records{golden_record(), golden_record()};
  records[1].intersection = true;
  const SamplePlan plan(records, {.intersection_weight = 2}, 3);
  int intersections = 0;
  constexpr int kDraws = 6000;
  for (int i = 0; i < kDraws; ++i) {
    intersections += plan.choose(static_cast<std::uint64_t>(i), 0, 1).record == 1 ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(intersections) / kDraws, 2.0 / 3, 0.02);
}

TEST(SamplePlan, ScenesWithAWrongPriorComeAsOftenAsAsked) {
  std::vector<Record> records{golden_record(), golden_record()};
  for (Record& record : records) record.truth = record.priors.front().nodes;
  for (Point3& node : records[1].truth) node.y += 0.05F;
  const SamplePlan plan(records, {.wrong_weight = 3}, 3);
  int wrong = 0;
  constexpr int kDraws = 6000;
  for (int i = 0; i < kDraws; ++i) {
    wrong += plan.choose(static_cast<std::uint64_t>(i), 0, 1).record == 1 ? 1 : 0;
  }
  EXPECT_NEAR(static_cast<double>(wrong) / kDraws, 0.75, 0.02);
}

TEST(SamplePlan, SameStepAndSlotGiveTheSameSample) {
  const std::vector<Record> records{golden_record()};
  const SamplePlan plan(records, {}, 3);
  const Choice a = plan.choose(17, 5, 8);
  const Choice b = plan.choose(17, 5, 8);
  EXPECT_EQ(a.t, b.t);
  EXPECT_EQ(a.source, b.source);
  EXPECT_NE(a.t, plan.choose(17, 6, 8).t);
}

}  // namespace
}  // namespace flowdlo::train
