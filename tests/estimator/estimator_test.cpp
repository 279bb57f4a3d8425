#include "flowdlo/estimator.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "flowdlo/weights.hpp"
#include "frame/temporary_folder.hpp"
#include "support/wave_frame.hpp"

namespace flowdlo {
namespace {

using ::testing::HasSubstr;
using testing::WaveFrame;

Config cpu() { return {.weights = FLOWDLO_WEIGHTS, .device = "cpu", .euler_steps = 2, .draws = 2}; }

Estimator make(const Config& config) {
  auto estimator = Estimator::create(config);
  if (!estimator) throw std::runtime_error(estimator.error().message);
  return *std::move(estimator);
}

TEST(Create, ListsEveryFaultOfTheConfig) {
  Config config = cpu();
  config.euler_steps = 0;
  config.draws = 65;
  const auto created = Estimator::create(config);
  ASSERT_FALSE(created);
  EXPECT_EQ(created.error().code, ErrorCode::kBadInput);
  EXPECT_THAT(created.error().message, HasSubstr("Config.euler_steps: expected 1 to 64, got 0"));
  EXPECT_THAT(created.error().message, HasSubstr("Config.draws: expected 1 to 64, got 65"));
}

TEST(Create, NamesTheWeightsThatAreMissing) {
  Config config = cpu();
  config.weights = "no/such/file.fdw";
  const auto created = Estimator::create(config);
  ASSERT_FALSE(created);
  EXPECT_THAT(created.error().message, HasSubstr("no/such/file.fdw"));
}

TEST(Create, RefusesADeviceThatIsNotThere) {
  Config config = cpu();
  config.device = "no such device";
  const auto created = Estimator::create(config);
  ASSERT_FALSE(created);
  EXPECT_EQ(created.error().code, ErrorCode::kNoDevice);
}

TEST(Create, RefusesADeviceWithoutAName) {
  Config config = cpu();
  config.device = "";
  const auto created = Estimator::create(config);
  ASSERT_FALSE(created);
  EXPECT_EQ(created.error().code, ErrorCode::kBadInput);
}

TEST(Create, AutoAlwaysFindsADevice) {
  Config config = cpu();
  config.device = "auto";
  EXPECT_FALSE(make(config).device().empty());
}

TEST(Create, QualityFastTakesStepsAndDrawsFromTheWeights) {
  const test::TemporaryFolder scratch;
  const auto file = scratch.path() / "fast.fdw";
  ASSERT_TRUE(set_fast_quality(FLOWDLO_WEIGHTS, 3, 1, file));
  Config config = cpu();
  config.weights = file;
  EXPECT_EQ(make(config).euler_steps(), 2) << "full is what Config says";
  config.quality = Quality::kFast;
  auto estimator = make(config);
  EXPECT_EQ(estimator.euler_steps(), 3);
  EXPECT_EQ(estimator.draws(), 1);
  const WaveFrame wave;
  const auto estimate = estimator.estimate(wave.frame());
  ASSERT_TRUE(estimate) << estimate.error().message;
  EXPECT_EQ(estimate->draws.size(), 1U);
}

TEST(Create, QualityFastOfWeightsThatSayNothingIsFull) {
  Config config = cpu();
  config.quality = Quality::kFast;
  const auto estimator = make(config);
  EXPECT_EQ(estimator.euler_steps(), 10);
  EXPECT_EQ(estimator.draws(), 4);
}

TEST(Create, QualityAutoIsFastUnlessStepsDrawsOrTheThesisGateAreAskedFor) {
  const test::TemporaryFolder scratch;
  const auto file = scratch.path() / "fast.fdw";
  ASSERT_TRUE(set_fast_quality(FLOWDLO_WEIGHTS, 3, 1, file));
  const Config config{.weights = file, .device = "cpu"};
  EXPECT_EQ(make(config).euler_steps(), 3);
  EXPECT_EQ(make(config).draws(), 1);
  Config two_draws = config;
  two_draws.draws = 2;
  EXPECT_EQ(make(two_draws).euler_steps(), 10);
  EXPECT_EQ(make(two_draws).draws(), 2);
  Config by_thesis = config;
  by_thesis.gate = GateChoice::kThesis;
  EXPECT_EQ(make(by_thesis).euler_steps(), 10);
  EXPECT_EQ(make(by_thesis).draws(), 4);
}

TEST(Estimate, FollowsTheRopeFromEndToEnd) {
  const WaveFrame wave;
  auto estimator = make(cpu());
  const auto estimate = estimator.estimate(wave.frame());
  ASSERT_TRUE(estimate) << estimate.error().message;
  const auto pixel = [&](const Point3& p) { return wave.camera.fx * p.x / p.z + wave.camera.cx; };
  EXPECT_NEAR(pixel(estimate->nodes.front()), 32, 8);
  EXPECT_NEAR(pixel(estimate->nodes.back()), 287, 8);
  for (std::size_t i = 1; i < kNodes; ++i) {
    EXPECT_GT(estimate->nodes[i].x, estimate->nodes[i - 1].x);
    EXPECT_NEAR(estimate->nodes[i].z, 0.415F, 0.02F);
  }
  EXPECT_GT(estimate->mask_agreement, 0.95F);
}

TEST(Estimate, OfUntrainedWeightsIsThePrior) {  // Eq. (3.33)
  auto estimator = make(cpu());
  const WaveFrame wave;
  Tensors tensors;
  const auto estimate = estimator.estimate(wave.frame(), tensors);
  ASSERT_TRUE(estimate);
  EXPECT_EQ(estimate->source, Source::kPrior);
  EXPECT_EQ(estimate->draw, -1);
  ASSERT_EQ(estimate->draws.size(), 2U);
  EXPECT_FALSE(estimate->draws[0].accepted);
  EXPECT_EQ(tensors.prior[3], estimate->nodes[1].x);
}

TEST(Estimate, StretchWithoutDepthHasNoSupportAndMoreDoubt) {  // Eq. (3.6), (3.7)
  auto estimator = make(cpu());
  WaveFrame wave;
  for (int v = 0; v < wave.height; ++v) {
    for (int u = 140; u < 200; ++u) wave.depth_m[static_cast<std::size_t>(v) * wave.width + u] = 0;
  }
  const auto estimate = estimator.estimate(wave.frame());
  ASSERT_TRUE(estimate);
  const auto gap = static_cast<std::size_t>(
      std::find(estimate->support.begin(), estimate->support.end(), std::uint8_t{0}) -
      estimate->support.begin());
  ASSERT_LT(gap, static_cast<std::size_t>(kNodes));
  EXPECT_GT(estimate->sigma_m[gap + 1], estimate->sigma_m[5]);
}

TEST(Estimate, SameSeedGivesTheSameBitsOnASecondEstimator) {
  const WaveFrame wave;
  auto one = make(cpu());
  auto two = make(cpu());
  Tensors first;
  Tensors second;
  Tensors again;
  ASSERT_TRUE(one.estimate(wave.frame(), first));
  ASSERT_TRUE(two.estimate(wave.frame(), second));
  ASSERT_TRUE(one.estimate(wave.frame(), again));
  EXPECT_EQ(first.prediction, second.prediction);
  EXPECT_EQ(first.prediction, again.prediction);
}

TEST(Estimate, AnotherSeedGivesOtherDraws) {
  const WaveFrame wave;
  Config config = cpu();
  auto one = make(config);
  config.seed = 1;
  auto two = make(config);
  Tensors first;
  Tensors second;
  ASSERT_TRUE(one.estimate(wave.frame(), first));
  ASSERT_TRUE(two.estimate(wave.frame(), second));
  EXPECT_NE(first.source, second.source);
  EXPECT_NE(first.prediction, second.prediction);
}

TEST(Estimate, TensorsHaveTheShapesOfTheSpecification) {  // spec section 3, --tensors
  const WaveFrame wave;
  auto estimator = make(cpu());
  Tensors t;
  ASSERT_TRUE(estimator.estimate(wave.frame(), t));
  EXPECT_EQ(t.source.size(), 2U * 64 * 3);
  EXPECT_EQ(t.visible.size(), 256U * 3);
  EXPECT_EQ(t.visible_valid.size(), 256U);
  EXPECT_EQ(t.path.size() % 2, 0U);
  EXPECT_EQ(t.prior.size(), 64U * 3);
  EXPECT_EQ(t.support.size(), 64U);
  EXPECT_EQ(t.draw_prior.size(), 2U * 64 * 3);
  EXPECT_EQ(t.draw_support.size(), 2U * 64);
  EXPECT_EQ(t.prediction.size(), 2U * 64 * 3);
  EXPECT_EQ(t.mask_field.size(), 4U * 160 * 120);
}

TEST(Estimate, WithoutDepthOnTheMaskSaysSo) {
  WaveFrame wave;
  std::fill(wave.depth_m.begin(), wave.depth_m.end(), 0.0F);
  auto estimator = make(cpu());
  const auto estimate = estimator.estimate(wave.frame());
  ASSERT_FALSE(estimate);
  EXPECT_EQ(estimate.error().code, ErrorCode::kNoEvidence);
  EXPECT_THAT(estimate.error().message, HasSubstr("depth"));
}

TEST(Estimate, OfAnEmptyMaskIsAnErrorNotACrash) {
  WaveFrame wave;
  std::fill(wave.mask.begin(), wave.mask.end(), std::uint8_t{0});
  auto estimator = make(cpu());
  EXPECT_FALSE(estimator.estimate(wave.frame()));
}

TEST(Estimate, OfASpeckHasNoPath) {
  WaveFrame wave;
  std::fill(wave.mask.begin(), wave.mask.end(), std::uint8_t{0});
  wave.mask[100 * 320 + 100] = 255;
  wave.depth_m[100 * 320 + 100] = 0.4F;
  auto estimator = make(cpu());
  const auto estimate = estimator.estimate(wave.frame());
  ASSERT_FALSE(estimate);
  EXPECT_EQ(estimate.error().code, ErrorCode::kNoPath);
}

TEST(Estimate, OfAMalformedFrameListsTheFaults) {
  const WaveFrame wave;
  Frame frame = wave.frame();
  frame.depth_m = frame.depth_m.first(100);
  frame.intrinsics.fx = -1;
  auto estimator = make(cpu());
  const auto estimate = estimator.estimate(frame);
  ASSERT_FALSE(estimate);
  EXPECT_EQ(estimate.error().code, ErrorCode::kBadInput);
  EXPECT_THAT(estimate.error().message, HasSubstr("depth_m"));
  EXPECT_THAT(estimate.error().message, HasSubstr("fx"));
}

TEST(Estimate, OfAFrameLargerThanPlannedWorksToo) {
  Config config = cpu();
  config.max_width = 64;
  config.max_height = 64;
  auto estimator = make(config);
  auto planned = make(cpu());
  const WaveFrame wave(960, 720, 20.0F);
  const auto grown = estimator.estimate(wave.frame());
  const auto direct = planned.estimate(wave.frame());
  ASSERT_TRUE(grown && direct);
  EXPECT_EQ(grown->nodes, direct->nodes);
}

TEST(Estimate, AFailedFrameDoesNotSpoilTheNext) {
  const WaveFrame wave;
  WaveFrame empty;
  std::fill(empty.mask.begin(), empty.mask.end(), std::uint8_t{0});
  auto estimator = make(cpu());
  const auto before = estimator.estimate(wave.frame());
  EXPECT_FALSE(estimator.estimate(empty.frame()));
  const auto after = estimator.estimate(wave.frame());
  ASSERT_TRUE(before && after);
  EXPECT_EQ(before->nodes, after->nodes);
}

TEST(MovedFrom, AnswersEveryCallWithoutHarm) {
  const WaveFrame wave;
  auto from = make(cpu());
  auto to = std::move(from);
  Tensors tensors;
  for (const auto& estimate :
       {from.estimate(wave.frame()), from.estimate(wave.frame(), tensors)}) {  // NOLINT: the point
    ASSERT_FALSE(estimate);
    EXPECT_EQ(estimate.error().code, ErrorCode::kBadInput);
    EXPECT_THAT(estimate.error().message, HasSubstr("moved from"));
  }
  EXPECT_EQ(from.device(), "");
  EXPECT_EQ(from.euler_steps(), 0);
  EXPECT_EQ(from.draws(), 0);
  EXPECT_TRUE(to.estimate(wave.frame()));
  from = std::move(to);
  EXPECT_TRUE(from.estimate(wave.frame()));
}

}  // namespace
}  // namespace flowdlo
