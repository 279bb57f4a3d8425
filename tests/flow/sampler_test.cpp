#include "flow/sampler.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "reference/program.hpp"
#include "support/conditions.hpp"
#include "support/naive_model.hpp"

namespace flowdlo {
namespace {

using testing::WaveConditions;

flow::ProgramFactory cpu(int threads = 2) {
  return [threads] { return reference::create_program(threads); };
}

/// The engine's prediction and the plain one of the same variant, for the first draw.
void expect_equal_to_the_naive_model(const weights::Variant& variant) {
  constexpr int kSteps = 2;
  const WaveConditions conditions(1);
  auto sampler = testing::make_sampler(variant, cpu(), conditions, kSteps);
  const auto prediction = sampler.sample(conditions.input());
  ASSERT_TRUE(prediction) << prediction.error().message;

  auto weights = weights::seeded(variant, 5);
  weights.metadata.mean = {0.0F, 0.0F, 0.42F};
  weights.metadata.scale = 0.1F;
  testing::NaiveInput input{conditions.frame, conditions.field, {}, {}, {}};
  const auto visible = evidence::visible_points(conditions.cloud);
  for (std::size_t i = 0; i < visible.points_cam.size(); ++i) {
    const auto& p = visible.points_cam[i];
    input.visible.push_back({static_cast<double>(p.x), static_cast<double>(p.y),
                             static_cast<double>(p.z), static_cast<double>(visible.valid[i])});
  }
  for (std::size_t node = 0; node < kNodes; ++node) {
    const auto& p = conditions.priors[0].nodes[node];
    input.draw_prior.push_back({static_cast<double>(p.x), static_cast<double>(p.y),
                                static_cast<double>(p.z),
                                static_cast<double>(conditions.priors[0].support[node])});
    const float* x = sampler.source().data() + node * 4;
    input.source.push_back(
        {static_cast<double>(x[0]), static_cast<double>(x[1]), static_cast<double>(x[2])});
  }
  const auto naive = testing::naive_sample(weights, input, kSteps);
  for (std::size_t node = 0; node < kNodes; ++node) {
    const auto& got = prediction->draws[0][node];
    const auto& want = naive.nodes[node];
    ASSERT_NEAR(got.x, want[0], 1e-5) << "node " << node;
    ASSERT_NEAR(got.y, want[1], 1e-5) << "node " << node;
    ASSERT_NEAR(got.z, want[2], 1e-5) << "node " << node;
    if (variant.head_channels == 4) {
      const double scale =
          std::log(static_cast<double>(prediction->sigma_m[0][node])) - naive.log_sigma[node];
      const double first =
          std::log(static_cast<double>(prediction->sigma_m[0][0])) - naive.log_sigma[0];
      ASSERT_NEAR(scale, first, 1e-4) << "node " << node;
    }
  }
}

TEST(Sampler, ThesisConfigurationEqualsTheNaiveModel) { expect_equal_to_the_naive_model({}); }

TEST(Sampler, DirectWithDepthResidualEqualsTheNaiveModel) {
  weights::Variant variant;
  variant.parameterization = ops::Parameterization::kDirect;
  variant.local_channels = 8;
  expect_equal_to_the_naive_model(variant);
}

TEST(Sampler, PreconditionedWithFrameNormalizationAndSigmaEqualsTheNaiveModel) {
  weights::Variant variant;
  variant.parameterization = ops::Parameterization::kPreconditioned;
  variant.normalization = weights::NormalizationKind::kFrame;
  variant.head_channels = 4;
  variant.local_channels = 8;
  expect_equal_to_the_naive_model(variant);
}

TEST(Sampler, WithoutVisiblePointsEqualsTheNaiveModel) {
  weights::Variant variant;
  variant.visible_points = false;
  expect_equal_to_the_naive_model(variant);
}

TEST(Sampler, SameSeedGivesTheSameBitsWhateverTheThreadsAndTheRun) {
  const WaveConditions conditions(2);
  auto one = testing::make_sampler({}, cpu(1), conditions, 3);
  auto two = testing::make_sampler({}, cpu(2), conditions, 3);
  const auto first = one.sample(conditions.input());
  const auto again = one.sample(conditions.input());
  const auto threaded = two.sample(conditions.input());
  ASSERT_TRUE(first && again && threaded);
  EXPECT_EQ(first->draws, again->draws);
  EXPECT_EQ(first->draws, threaded->draws);
}

TEST(Sampler, ADrawsBitsDoNotDependOnTheNumberOfDraws) {
  const WaveConditions one(1);
  const WaveConditions five(5);
  auto few = testing::make_sampler({}, cpu(), one, 3);
  auto many = testing::make_sampler({}, cpu(), five, 3);
  const auto a = few.sample(one.input());
  const auto b = many.sample(five.input());
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->draws[0], b->draws[0]);
}

TEST(Sampler, EveryDrawReadsItsOwnPrior) {
  weights::Variant variant;
  variant.parameterization = ops::Parameterization::kPreconditioned;
  variant.prior_sd = 1e-3F;  // predictions stay at their priors
  const WaveConditions conditions(3);
  auto sampler = testing::make_sampler(variant, cpu(), conditions, 4);
  const auto prediction = sampler.sample(conditions.input());
  ASSERT_TRUE(prediction);
  for (std::size_t draw = 0; draw < 3; ++draw) {
    EXPECT_NEAR(prediction->draws[draw][30].y, conditions.priors[draw].nodes[30].y, 1e-3) << draw;
  }
}

TEST(Sampler, VisiblePointsComeBackAsTheEvidenceRoomPicksThem) {
  const WaveConditions conditions(1);
  auto sampler = testing::make_sampler({}, cpu(), conditions, 1);
  const auto prediction = sampler.sample(conditions.input());
  ASSERT_TRUE(prediction);
  EXPECT_EQ(prediction->visible.points_cam, evidence::visible_points(conditions.cloud).points_cam);
}

TEST(Sampler, FrameBeyondTheCapacityGrowsIt) {
  const WaveConditions small(1);
  const WaveConditions large(1, 640, 480, 20.0F);
  auto sampler = testing::make_sampler({}, cpu(), small, 2);
  auto fresh = testing::make_sampler({}, cpu(), large, 2);
  const auto grown = sampler.sample(large.input());
  const auto direct = fresh.sample(large.input());
  ASSERT_TRUE(grown && direct);
  EXPECT_EQ(grown->draws, direct->draws);
}

TEST(Sampler, EveryVariantStaysFinite) {
  const WaveConditions conditions(4);
  for (const auto& variant : testing::all_variants()) {
    auto sampler = testing::make_sampler(variant, cpu(), conditions, 2);
    const auto prediction = sampler.sample(conditions.input());
    ASSERT_TRUE(prediction);
    for (const auto& draw : prediction->draws) {
      for (const auto& node : draw) {
        ASSERT_TRUE(std::isfinite(node.x) && std::isfinite(node.y) && std::isfinite(node.z));
      }
    }
  }
}

}  // namespace
}  // namespace flowdlo
