// Budget: what is left out of an estimate for want of time, and what never is.
#include "estimator/budget.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "flowdlo/estimator.hpp"
#include "support/rose_frame.hpp"
#include "support/wave_frame.hpp"

namespace flowdlo {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr double kNoTime_ms = 1e-6;
constexpr double kAllTheTime_ms = 1e9;

Config within(double budget_ms, int threads = 1) {
  return {.weights = FLOWDLO_DEFAULT_WEIGHTS,
          .device = "cpu",
          .euler_steps = 1,
          .draws = 1,
          .threads = threads,
          .budget_ms = budget_ms};
}

Estimate estimated(const Config& config, const Frame& frame) {
  auto estimator = Estimator::create(config);
  if (!estimator) throw std::runtime_error(estimator.error().message);
  auto estimate = estimator->estimate(frame);
  if (!estimate) throw std::runtime_error(estimate.error().message);
  return *std::move(estimate);
}

TEST(Budget, WithoutOneThereIsTimeForAnything) {
  EXPECT_TRUE(estimator::Budget(0).leaves(kAllTheTime_ms));
  EXPECT_FALSE(estimator::Budget(0).bounded());
}

TEST(Budget, LeavesWhatIsNotSpent) {
  const estimator::Budget budget(kAllTheTime_ms);
  EXPECT_TRUE(budget.bounded());
  EXPECT_TRUE(budget.leaves(0.9 * kAllTheTime_ms));
  EXPECT_FALSE(budget.leaves(1.1 * kAllTheTime_ms));
}

TEST(Cost, RisesAtOnceAndFallsSlowly) {
  estimator::Cost cost(1);
  EXPECT_EQ(cost.of(3), 3);
  cost.saw(20, 2);
  EXPECT_EQ(cost.of(1), 10);
  cost.saw(0, 5);
  EXPECT_NEAR(cost.of(1), 9, 1e-9);
  cost.saw(7, 0);  // of nothing, which says nothing
  EXPECT_NEAR(cost.of(1), 9, 1e-9);
}

TEST(Cost, OfWhatIsLeftOutIsForgottenInTime) {
  estimator::Cost cost(1);
  cost.saw(1000, 1);  // one slow frame
  for (int frame = 0; frame < 200; ++frame) cost.left_out();
  EXPECT_LT(cost.of(1), 20);
  EXPECT_GT(cost.of(1), 0);
}

TEST(Budget, WithoutTimeAClearFrameIsThePriorOfItsFirstReading) {
  const testing::WaveFrame wave;
  const Estimate estimate = estimated(within(kNoTime_ms), wave.frame());
  EXPECT_THAT(estimate.left_out, ElementsAre(LeftOut::kModel, LeftOut::kField, LeftOut::kReadings));
  EXPECT_EQ(estimate.source, Source::kPrior);
  EXPECT_THAT(estimate.draws, IsEmpty());
  EXPECT_GT(estimate.confidence, 0.9F);
}

TEST(Budget, WithoutTimeADoubtfulFrameIsReadOnce) {
  const testing::RoseFrame rose;
  for (const int threads : {1, 2}) {
    Config config = within(kNoTime_ms, threads);
    const Estimate beside = estimated(config, rose.frame());
    EXPECT_THAT(beside.left_out, ElementsAre(LeftOut::kModel, LeftOut::kField, LeftOut::kReadings));
    config.field = FieldChoice::kOff;
    const Estimate alone = estimated(config, rose.frame());
    EXPECT_THAT(alone.left_out, ElementsAre(LeftOut::kModel));
    for (const Estimate& estimate : {beside, alone}) {
      EXPECT_EQ(estimate.readings, 1);
      EXPECT_EQ(estimate.timings.readings_ms, 0);
    }
  }
}

TEST(Budget, WithTimeEnoughTheEstimateIsThatWithoutABudget) {
  const testing::RoseFrame rose;
  const Estimate without = estimated(within(0), rose.frame());
  const Estimate with = estimated(within(kAllTheTime_ms), rose.frame());
  EXPECT_THAT(with.left_out, IsEmpty());
  EXPECT_GT(with.readings, 1);
  EXPECT_EQ(with.nodes, without.nodes);
  EXPECT_EQ(with.sigma_m, without.sigma_m);
  EXPECT_EQ(with.confidence, without.confidence);
}

TEST(Budget, WhereTensorsAreAskedForTheModelIsNeverLeftOut) {
  const testing::WaveFrame wave;
  auto estimator = Estimator::create(within(kNoTime_ms));
  ASSERT_TRUE(estimator);
  Tensors tensors;
  const auto estimate = estimator->estimate(wave.frame(), tensors);
  ASSERT_TRUE(estimate);
  EXPECT_THAT(estimate->left_out, Not(Contains(LeftOut::kModel)));
  EXPECT_EQ(tensors.draws, 1);
  EXPECT_EQ(tensors.prediction.size(), 3 * kNodes);
}

}  // namespace
}  // namespace flowdlo
