// The whole model on Vulkan against the CPU back end: every variant, ten steps. Any Vulkan device
// will do; without one the tests are skipped, and say so.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "estimator/field_trial.hpp"
#include "estimator/self_test.hpp"
#include "field/network.hpp"
#include "reference/program.hpp"
#include "support/conditions.hpp"
#include "vulkan/backend.hpp"
#include "weights/field_weights.hpp"

namespace flowdlo {
namespace {

using testing::WaveConditions;

constexpr int kSteps = 10;

/// One device for the whole process: its pipelines are compiled once.
std::shared_ptr<vulkan::Device> device() {
  static const auto opened = vulkan::open_device({.wanted = "vulkan", .validation = true});
  return opened ? *opened : nullptr;
}

class VulkanParity : public ::testing::Test {
 protected:
  void SetUp() override {
    if (device() == nullptr) GTEST_SKIP() << "no usable Vulkan device";
  }
  void TearDown() override {
    if (device() == nullptr) return;
    for (const auto& message : vulkan::validation_messages(*device())) ADD_FAILURE() << message;
  }
};

flow::ProgramFactory on_device() {
  return [] {  // a starved CPU driver is slow, not lost
    return vulkan::create_program(device(), {.timeout_ms = 60000, .pipeline_cache = {}});
  };
}

flow::ProgramFactory on_cpu() {
  return [] { return reference::create_program(2); };
}

std::string name_of(const weights::Variant& variant) {
  return "parameterization " + std::to_string(static_cast<int>(variant.parameterization)) + ", " +
         std::to_string(variant.local_channels) + " local channels, " +
         std::to_string(variant.head_channels) + " head channels, " +
         (variant.visible_points ? "with" : "without") + " visible points, normalization " +
         std::to_string(static_cast<int>(variant.normalization));
}

/// Largest distance of a node in units of the normalised state.
double difference(const flow::Prediction& a, const flow::Prediction& b, double scale_m) {
  double worst = 0;
  for (std::size_t draw = 0; draw < a.draws.size(); ++draw) {
    for (std::size_t node = 0; node < kNodes; ++node) {
      const auto& p = a.draws[draw][node];
      const auto& q = b.draws[draw][node];
      for (const float d : {p.x - q.x, p.y - q.y, p.z - q.z}) {
        worst =
            std::isfinite(d) ? std::max(worst, std::abs(static_cast<double>(d)) / scale_m) : 1e9;
      }
    }
  }
  return worst;
}

TEST_F(VulkanParity, EveryVariantAgreesWithin1e4OfTheNormalisedStateAfterTenSteps) {
  const WaveConditions conditions(2);
  double worst = 0;
  for (const auto& variant : testing::all_variants()) {
    auto gpu = testing::make_sampler(variant, on_device(), conditions, kSteps);
    auto cpu = testing::make_sampler(variant, on_cpu(), conditions, kSteps);
    const auto got = gpu.sample(conditions.input());
    const auto want = cpu.sample(conditions.input());
    ASSERT_TRUE(got) << got.error().message;
    ASSERT_TRUE(want) << want.error().message;
    // Frame normalisation of this wave has a scale of about 7 cm; 5 cm is the stricter yardstick.
    const double error = difference(*got, *want, 0.05);
    EXPECT_LE(error, 1e-4) << name_of(variant);
    EXPECT_EQ(got->visible.points_cam, want->visible.points_cam) << name_of(variant);
    if (variant.head_channels == 4) {
      for (std::size_t node = 0; node < kNodes; ++node) {
        EXPECT_NEAR(got->sigma_m[1][node] / want->sigma_m[1][node], 1.0, 1e-3) << name_of(variant);
      }
    }
    worst = std::max(worst, error);
  }
  std::printf("largest difference over all variants: %.2g of the normalised state\n", worst);
}

TEST_F(VulkanParity, TheHostSamplesThePointsOnCpuDriversAlone) {
  const bool is_cpu = vulkan::report(*device()).kind == DeviceKind::kCpu;
  EXPECT_EQ(on_device()()->host_samples_points(), is_cpu);
}

TEST_F(VulkanParity, PointsAreTheSameWhoeverSamplesThem) {
  const WaveConditions conditions(1);
  const auto known = evidence::visible_points(conditions.cloud);
  auto sampler = testing::make_sampler({}, on_device(), conditions, 1);
  flow::SampleInput input = conditions.input();
  const auto sampled = sampler.sample(input);
  input.visible = &known;
  const auto given = sampler.sample(input);

  ASSERT_TRUE(sampled && given);
  EXPECT_EQ(sampled->visible.points_cam, known.points_cam);
  EXPECT_EQ(given->visible.points_cam, known.points_cam);
  EXPECT_EQ(sampled->draws, given->draws);
}

TEST_F(VulkanParity, OneSubmissionAFrame) {
  const WaveConditions conditions(4);
  auto sampler = testing::make_sampler({}, on_device(), conditions, kSteps);
  const auto before = vulkan::submit_count(*device());
  for (int frame = 0; frame < 3; ++frame) ASSERT_TRUE(sampler.sample(conditions.input()));
  EXPECT_EQ(vulkan::submit_count(*device()) - before, 3U);
}

TEST_F(VulkanParity, SameSeedGivesTheSameBitsTwiceAndAcrossDrawCounts) {
  const WaveConditions one(1);
  const WaveConditions four(4);
  auto few = testing::make_sampler({}, on_device(), one, kSteps);
  auto many = testing::make_sampler({}, on_device(), four, kSteps);
  const auto a = few.sample(one.input());
  const auto again = few.sample(one.input());
  const auto b = many.sample(four.input());
  ASSERT_TRUE(a && again && b);
  EXPECT_EQ(a->draws, again->draws);
  EXPECT_EQ(a->draws[0], b->draws[0]);
}

TEST_F(VulkanParity, FrameBeyondTheCapacityGrowsIt) {
  const WaveConditions small(1);
  const WaveConditions large(1, 640, 480, 20.0F);
  auto sampler = testing::make_sampler({}, on_device(), small, 2);
  auto fresh = testing::make_sampler({}, on_device(), large, 2);
  const auto grown = sampler.sample(large.input());
  const auto direct = fresh.sample(large.input());
  ASSERT_TRUE(grown) << grown.error().message;
  ASSERT_TRUE(direct);
  EXPECT_EQ(grown->draws, direct->draws);
}

TEST_F(VulkanParity, SelfTestPasses) {
  const auto verdict = estimator::self_test(on_device());
  EXPECT_TRUE(verdict.passed) << verdict.text;
}

TEST_F(VulkanParity, TheStrandFieldThatShipsAgreesWithTheCpus) {
  auto loaded = weights::load_field(std::filesystem::path(FLOWDLO_FIELD_WEIGHTS));
  ASSERT_TRUE(loaded) << loaded.error().message;
  const auto weights = std::make_shared<const weights::FieldWeights>(*std::move(loaded));
  auto gpu = field::Network::create(weights, on_device());
  auto cpu = field::Network::create(weights, on_cpu());
  ASSERT_TRUE(gpu) << gpu.error().message;
  ASSERT_TRUE(cpu);
  const auto trial = estimator::try_field(*gpu, *cpu);
  ASSERT_TRUE(trial) << trial.error().message;
  EXPECT_LT(trial->difference, 1e-4F);
  EXPECT_TRUE(trial->agrees());
  EXPECT_GT(trial->device_ms, 0);
  EXPECT_GT(trial->cpu_ms, 0);
}

}  // namespace
}  // namespace flowdlo
