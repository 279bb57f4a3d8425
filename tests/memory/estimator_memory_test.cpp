// What an estimator does when memory runs out: an Error or the right bits, and no harm to the next
// call.
#include <gmock/gmock.h>

#include <memory>
#include <optional>

#include "flowdlo/estimator.hpp"
#include "memory/sweep.hpp"
#include "support/estimate_bits.hpp"
#include "support/rose_frame.hpp"
#include "support/wave_frame.hpp"

namespace flowdlo::testing {
namespace {

/// Small, so that a sweep is quick; two threads, so that there are workers.
Config cpu(const char* weights = FLOWDLO_WEIGHTS) {
  return {.weights = weights,
          .device = "cpu",
          .euler_steps = 1,
          .draws = 2,
          .threads = 2,
          .max_width = 160,
          .max_height = 120};
}

std::string bits_of_result(const Result<Estimate>& estimate) { return bits_of(*estimate); }

TEST(EstimatorMemory, CreateSurvivesEveryAllocation) {
  const WaveFrame wave(160, 120, 7.0F);
  const Config config = cpu();
  sweep(
      "Estimator::create", [&] { return Estimator::create(config); },
      [&](Result<Estimator>& made) { return bits_of(*made->estimate(wave.frame())); }, {12, 12});
}

TEST(EstimatorMemory, EstimateOfAClearFrameSurvivesEveryAllocation) {
  const WaveFrame wave(160, 120, 7.0F);
  auto estimator = Estimator::create(cpu());
  ASSERT_TRUE(estimator);
  sweep(
      "Estimator::estimate", [&] { return estimator->estimate(wave.frame()); }, bits_of_result);
}

TEST(EstimatorMemory, EstimateWithTensorsSurvivesEveryAllocation) {
  const WaveFrame wave(160, 120, 7.0F);
  auto estimator = Estimator::create(cpu());
  ASSERT_TRUE(estimator);
  Tensors tensors;
  sweep(
      "Estimator::estimate with tensors",
      [&] { return estimator->estimate(wave.frame(), tensors); },
      [&](const Result<Estimate>& estimate) { return bits_of(*estimate) + bits_of(tensors); },
      {4, 8});
}

TEST(EstimatorMemory, EstimateWithHintsSurvivesEveryAllocation) {
  const WaveFrame wave(160, 120, 7.0F);
  auto estimator = Estimator::create(cpu());
  ASSERT_TRUE(estimator);
  const auto before = estimator->estimate(wave.frame());
  ASSERT_TRUE(before);
  const Hints hints{.first_end = before->nodes.back(),
                    .ends = {before->nodes.front(), Pixel{80, 60}},
                    .rope_length_m = 0.4,
                    .previous = before->nodes};
  sweep(
      "Estimator::estimate with hints", [&] { return estimator->estimate(wave.frame(), hints); },
      bits_of_result);
}

TEST(EstimatorMemory, EstimateOfSeveralRopesSurvivesEveryAllocation) {
  WaveFrame frame(160, 120, 7.0F);
  for (std::size_t v = 108; v < 114; ++v) {  // a straight one below the wave
    for (std::size_t u = 20; u < 140; ++u) {
      frame.mask[160 * v + u] = 255;
      frame.depth_m[160 * v + u] = 0.5F;
    }
  }
  Config config = cpu();
  config.ropes = 2;
  auto estimator = Estimator::create(config);
  ASSERT_TRUE(estimator);
  sweep(
      "Estimator::estimate_ropes", [&] { return estimator->estimate_ropes(frame.frame()); },
      [](const Result<Ropes>& found) {
        std::string bits;
        for (const Estimate& rope : found->ropes) bits += bits_of(rope);
        append(bits, found->crossings);
        append(bits, found->instances);
        return bits;
      },
      {12, 12});
}

TEST(EstimatorMemory, TheCurveSurvivesEveryAllocation) {
  const WaveFrame wave(160, 120, 7.0F);
  auto estimator = Estimator::create(cpu());
  ASSERT_TRUE(estimator);
  const auto estimate = estimator->estimate(wave.frame());
  ASSERT_TRUE(estimate);
  sweep(
      "Estimate::curve", [&] { return estimate->curve(500); },
      [](const Result<std::vector<Point3>>& curve) {
        std::string bits;
        append(bits, *curve);
        return bits;
      });
}

TEST(EstimatorMemory, EstimateOfAFrameInDoubtSurvivesEveryAllocation) {
  const RoseFrame frame;
  auto estimator = Estimator::create(cpu(FLOWDLO_DEFAULT_WEIGHTS));
  ASSERT_TRUE(estimator);
  const auto estimate = estimator->estimate(frame.frame());
  ASSERT_TRUE(estimate);
  ASSERT_GT(estimate->readings, 1) << "other readings are what this is about";
  sweep(
      "Estimator::estimate in doubt", [&] { return estimator->estimate(frame.frame()); },
      bits_of_result);
}

TEST(EstimatorMemory, AFrameLargerThanPlannedSurvivesEveryAllocationOfItsProgram) {
  const WaveFrame wave(160, 120, 7.0F);
  const WaveFrame large(320, 240, 9.0F);
  std::optional<Estimator> estimator;
  const auto renew = [&] { estimator.emplace(*Estimator::create(cpu())); };
  renew();
  const std::string of_small = bits_of(*estimator->estimate(wave.frame()));
  const std::string of_large = bits_of(*estimator->estimate(large.frame()));
  const long total = [&] {
    renew();
    const FailingAllocation counting(Fails::kNever, 0);
    (void)estimator->estimate(large.frame());
    return FailingAllocation::count();
  }();
  for (const Fails fails : {Fails::kOnce, Fails::kFromOn}) {
    for (const long number : numbers_to_fail(total, {4, 10})) {
      SCOPED_TRACE(number);
      renew();
      const auto got = [&] {
        const FailingAllocation failing(fails, number);
        return estimator->estimate(large.frame());
      }();
      if (got) {
        EXPECT_EQ(bits_of(*got), of_large);
      }
      const auto small = estimator->estimate(wave.frame());
      ASSERT_TRUE(small) << small.error().message;
      EXPECT_EQ(bits_of(*small), of_small);
      const auto again = estimator->estimate(large.frame());
      ASSERT_TRUE(again) << again.error().message;
      EXPECT_EQ(bits_of(*again), of_large);
    }
  }
}

TEST(EstimatorMemory, MovingAndDestroyingNeedNone) {
  const WaveFrame wave(160, 120, 7.0F);
  auto first = Estimator::create(cpu());
  auto second = Estimator::create(cpu());
  ASSERT_TRUE(first && second);
  const std::string expected = bits_of(*first->estimate(wave.frame()));
  auto moved = std::make_unique<Estimator>(*std::move(first));
  {
    const FailingAllocation failing(Fails::kFromOn, 1);
    *moved = *std::move(second);  // destroys the first
    Estimator other = std::move(*moved);
    *moved = std::move(other);
    EXPECT_EQ(FailingAllocation::count(), 0);
  }
  EXPECT_EQ(bits_of(*moved->estimate(wave.frame())), expected);
  const FailingAllocation failing(Fails::kFromOn, 1);
  moved.reset();
}

TEST(EstimatorMemory, WhatAFrameLacksIsToldOrMemoryIs) {
  const WaveFrame wave(160, 120, 7.0F);
  Frame broken = wave.frame();
  broken.depth_m = broken.depth_m.first(100);
  for (long number = 1; number < 20; ++number) {
    const auto checked = [&] {
      const FailingAllocation failing(Fails::kFromOn, number);
      return validate(broken);
    }();
    ASSERT_FALSE(checked);
    EXPECT_THAT(checked.error().code,
                ::testing::AnyOf(ErrorCode::kBadInput, ErrorCode::kOutOfMemory));
  }
}

}  // namespace
}  // namespace flowdlo::testing
