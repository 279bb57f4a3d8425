// The libtorch model against spec section 6: names, shapes, counts, masking.
#include <gtest/gtest.h>

#include <set>

#include "support/conditions.hpp"
#include "train/velocity_model.hpp"
#include "train/weights_exchange.hpp"

namespace flowdlo::train {
namespace {

std::int64_t parameters_of(const weights::Variant& variant) {
  std::int64_t count = 0;
  for (const auto& parameter : VelocityModel(variant)->parameters()) count += parameter.numel();
  return count;
}

ModelInput random_input(std::int64_t batch, int channels) {
  torch::manual_seed(2);
  ModelInput input;
  input.state = torch::randn({batch, 64, 3});
  input.time = torch::rand({batch});
  input.prior = torch::randn({batch, 64, 3});
  input.support = torch::ones({batch, 64, 1});
  input.points = torch::randn({batch, 256, 3});
  input.valid = torch::ones({batch, 256});
  input.features = torch::randn({batch, 64, channels});
  return input;
}

TEST(VelocityModel, ThesisConfigurationHas5815044Parameters) {
  EXPECT_EQ(parameters_of({}), 5815044);
}

TEST(VelocityModel, ParametersOfEveryVariantAreTheManifests) {
  for (const auto& variant : testing::all_variants()) {
    const auto named = VelocityModel(variant)->named_parameters();
    const auto manifest = weights::manifest(variant);
    ASSERT_EQ(named.size(), manifest.size());
    for (const auto& expected : manifest) {
      ASSERT_TRUE(named.contains(expected.name)) << expected.name;
      const std::vector<std::int64_t> shape(expected.shape.begin(), expected.shape.end());
      ASSERT_EQ(named[expected.name].sizes().vec(), shape) << expected.name;
    }
  }
}

TEST(VelocityModel, WeightsComeBackFromTheModelAsTheyWentIn) {
  const auto weights = weights::seeded({}, 3);
  VelocityModel model{weights::Variant{}};
  fill(*model, weights);
  const auto back = tensors_of(*model);
  ASSERT_EQ(back.size(), weights.tensors.size());
  for (std::size_t i = 0; i < back.size(); ++i) {
    EXPECT_EQ(back[i].name, weights.tensors[i].name);
    EXPECT_EQ(back[i].values, weights.tensors[i].values) << back[i].name;
  }
}

TEST(VelocityModel, PointsThatAreNotValidChangeNothing) {
  const torch::NoGradGuard no_gradients;
  VelocityModel model{weights::Variant{}};
  ModelInput input = random_input(2, 6);
  input.valid.slice(1, 100).zero_();
  const auto before = model->forward(input, torch::kFloat32);
  input.points.slice(1, 100).fill_(7);
  EXPECT_TRUE(torch::equal(before, model->forward(input, torch::kFloat32)));
  input.points.slice(1, 0, 100).add_(0.1);
  EXPECT_FALSE(torch::equal(before, model->forward(input, torch::kFloat32)));
}

TEST(VelocityModel, NoValidPointAtAllGivesFiniteOutputAndGradients) {
  VelocityModel model{weights::Variant{}};
  ModelInput input = random_input(2, 6);
  input.valid[1].zero_();
  const auto output = model->forward(input, torch::kFloat32);
  EXPECT_TRUE(torch::isfinite(output).all().item<bool>());
  output.square().mean().backward();
  for (const auto& parameter : model->parameters()) {
    EXPECT_TRUE(torch::isfinite(parameter.grad()).all().item<bool>());
  }
}

TEST(VelocityModel, Bf16StaysNearF32) {
  const torch::NoGradGuard no_gradients;
  VelocityModel model{weights::Variant{}};
  const ModelInput input = random_input(4, 6);
  const auto f32 = model->forward(input, torch::kFloat32);
  const auto bf16 = model->forward(input, torch::kBFloat16);
  EXPECT_EQ(bf16.scalar_type(), torch::kFloat32);
  EXPECT_LT(((f32 - bf16).norm() / f32.norm()).item<double>(), 0.02);
}

TEST(Velocity, PreconditionedWithZeroOutputLeadsToThePrior) {
  weights::Variant variant;
  variant.parameterization = ops::Parameterization::kPreconditioned;
  variant.prior_sd = 1e-3F;
  torch::manual_seed(1);
  const auto prior = torch::randn({1, 64, 3}, torch::kFloat64);
  auto state = torch::randn({1, 64, 3}, torch::kFloat64);
  constexpr int kSteps = 10;
  for (int k = 0; k < kSteps; ++k) {
    const auto time = torch::full({1}, static_cast<double>(k) / kSteps, torch::kFloat64);
    state = state + velocity(variant, torch::zeros_like(state), state, time, prior) / kSteps;
  }
  EXPECT_LT((state - prior).abs().max().item<double>(), 1e-3);
}

}  // namespace
}  // namespace flowdlo::train
