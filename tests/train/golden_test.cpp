// The engine against vectors that libtorch computed in double precision; needs no libtorch.
#include "train/golden.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "reference/normalization.hpp"
#include "reference/program.hpp"
#include "train/record_conditions.hpp"
#include "train/record_file.hpp"
#ifdef FLOWDLO_WITH_VULKAN
#include "support/source_dir.hpp"
#include "vulkan/backend.hpp"
#endif

namespace flowdlo {
namespace {

const std::filesystem::path kFolder = test::source_dir() / "tests/golden";

std::string name_of(const weights::Variant& variant) {
  return "parameterization " + std::to_string(static_cast<int>(variant.parameterization)) + ", " +
         std::to_string(variant.local_channels) + " local channels, head " +
         std::to_string(variant.head_channels);
}

weights::Weights golden_weights(const weights::Variant& variant) {
  auto weights = weights::seeded(variant, train::kGoldenWeightsSeed);
  const auto& norm = train::kGoldenNorm;
  weights.metadata.mean = {norm[0], norm[1], norm[2]};
  weights.metadata.scale = norm[3];
  return weights;
}

/// Largest difference of any coordinate, metres.
double difference_m(const Centerline& nodes, const std::vector<float>& golden) {
  double worst = 0;
  for (std::size_t i = 0; i < kNodes; ++i) {
    const float got[3] = {nodes[i].x, nodes[i].y, nodes[i].z};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double error =
          std::abs(static_cast<double>(got[axis]) - static_cast<double>(golden[i * 3 + axis]));
      worst = std::isfinite(error) ? std::max(worst, error) : 1e9;
    }
  }
  return worst;
}

/// Both checks of every golden case on one back end.
void expect_golden(const flow::ProgramFactory& factory) {
  const auto cases = train::read_golden(kFolder);
  const auto shard = train::read_shard(kFolder / "golden.records");
  ASSERT_TRUE(cases) << cases.error().message;
  ASSERT_TRUE(shard) << shard.error().message;
  const testing::RecordConditions conditions(shard->records.front());
  ASSERT_FALSE(cases->empty());
  for (const auto& golden : *cases) {
    const auto weights = golden_weights(golden.variant);
    const auto sampled = conditions.sample(weights, factory, train::kGoldenSteps);
    ASSERT_TRUE(sampled) << sampled.error().message;
    EXPECT_LE(difference_m(sampled->draws[0], golden.nodes), 0.05e-3) << name_of(golden.variant);
  }
}

TEST(Golden, RecordIsTheOneThatTheTrainerDraws) {
  const auto shard = train::read_shard(kFolder / "golden.records");
  ASSERT_TRUE(shard) << shard.error().message;
  const auto drawn = train::golden_record();
  EXPECT_EQ(shard->records.front().mask, drawn.mask);
}

TEST(Golden, CpuBackEndEndsWithin50MicrometresOfLibtorchInDouble) {
  expect_golden([] { return reference::create_program(2); });
}

TEST(Golden, CpuBackEndsFirstVelocityIsWithin1e4OfLibtorchInDouble) {
  const auto cases = train::read_golden(kFolder);
  const auto shard = train::read_shard(kFolder / "golden.records");
  ASSERT_TRUE(cases && shard);
  const testing::RecordConditions conditions(shard->records.front());
  for (const auto& golden : *cases) {
    const auto weights = golden_weights(golden.variant);
    const auto one = conditions.sample(
        weights, [] { return reference::create_program(2); }, 1);
    ASSERT_TRUE(one) << one.error().message;
    const bool global = golden.variant.normalization == weights::NormalizationKind::kGlobal;
    if (!global) continue;  // the norm of a frame is the back end's own
    auto sampler = flow::Sampler::create(std::make_shared<const weights::Weights>(weights),
                                         [] { return reference::create_program(1); },
                                         {.draws = 1, .steps = 1, .seed = 0, .capacity = {}});
    ASSERT_TRUE(sampler);
    const auto& norm = train::kGoldenNorm;
    double worst = 0;
    double largest = 0;
    for (std::size_t i = 0; i < kNodes; ++i) {
      const float got[3] = {one->draws[0][i].x, one->draws[0][i].y, one->draws[0][i].z};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const float velocity = (got[axis] - norm[axis]) / norm[3] - sampler->source()[i * 4 + axis];
        const auto want = static_cast<double>(golden.velocity[i * 3 + axis]);
        worst = std::max(worst, std::abs(static_cast<double>(velocity) - want));
        largest = std::max(largest, std::abs(want));
      }
    }
    EXPECT_LE(worst, 1e-4 * largest) << name_of(golden.variant);
  }
}

#ifdef FLOWDLO_WITH_VULKAN
TEST(Golden, VulkanEndsWithin50MicrometresOfLibtorchInDouble) {
  const auto device = vulkan::open_device({.wanted = "vulkan"});
  if (!device) GTEST_SKIP() << "no usable Vulkan device";
  expect_golden([&] { return vulkan::create_program(*device); });
}
#endif

}  // namespace
}  // namespace flowdlo
