#include "train/recipe.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "support/source_dir.hpp"

namespace flowdlo::train {
namespace {

const std::filesystem::path kRecipes = test::source_dir() / "lab/train/recipes";

TEST(Recipe, EveryRecipeOfTheRepositoryIsReadAndWritesItself) {
  for (const char* name : {"thesis.json", "robust.json", "smoke.json"}) {
    const auto recipe = read_recipe(kRecipes / name);
    ASSERT_TRUE(recipe) << recipe.error().message;
    const auto again = parse_recipe(to_json(*recipe), name);
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_EQ(to_json(*again), to_json(*recipe));
    EXPECT_EQ(again->variant, recipe->variant);
  }
}

TEST(Recipe, AblationsOfTheThesisDifferInTheirVariantOnly) {
  const auto full = read_recipe(kRecipes / "ablation/full.json");
  ASSERT_TRUE(full) << full.error().message;
  for (const char* name : {"no-points", "direct", "residual"}) {
    auto recipe = read_recipe(kRecipes / "ablation" / (std::string(name) + ".json"));
    ASSERT_TRUE(recipe) << recipe.error().message;
    EXPECT_NE(recipe->variant, full->variant) << name;
    recipe->variant = full->variant;
    recipe->name = full->name;
    EXPECT_EQ(to_json(*recipe), to_json(*full)) << name;
  }
}

TEST(Recipe, EveryAblationHasTheSameBudget) {
  const auto full = read_recipe(kRecipes / "ablation/full.json");
  const auto ours = read_recipe(kRecipes / "ablation/preconditioned.json");
  ASSERT_TRUE(full);
  ASSERT_TRUE(ours) << ours.error().message;
  EXPECT_EQ(ours->optimizer.steps, full->optimizer.steps);
  EXPECT_EQ(ours->optimizer.batch, full->optimizer.batch);
  EXPECT_EQ(ours->data.training_scenes, full->data.training_scenes);
}

TEST(Recipe, ThesisIsSection413) {
  const auto recipe = read_recipe(kRecipes / "thesis.json");
  ASSERT_TRUE(recipe);
  EXPECT_EQ(recipe->variant, weights::Variant{});
  EXPECT_EQ(recipe->optimizer.batch, 64);
  EXPECT_EQ(recipe->optimizer.steps, 20000);
  EXPECT_DOUBLE_EQ(recipe->optimizer.rate, 3e-4);
  EXPECT_DOUBLE_EQ(recipe->optimizer.final_rate, 3e-6);
  EXPECT_EQ(recipe->optimizer.weight_decay, 0);
  EXPECT_DOUBLE_EQ(recipe->objective.spacing, 0.02);
  EXPECT_DOUBLE_EQ(recipe->objective.bending, 0.01);
  EXPECT_DOUBLE_EQ(recipe->sampling.rotation_share, 0.75);
  EXPECT_DOUBLE_EQ(recipe->sampling.intersection_weight, 2);
}

TEST(Recipe, EveryFaultIsListed) {
  const auto recipe = parse_recipe(
      R"({"name": "x", "speed": 1, "optimizer": {"batch": 0, "rate": "fast"},
          "variant": {"prior_kind": "best"}})",
      "r.json");
  ASSERT_FALSE(recipe);
  const std::string& text = recipe.error().message;
  for (const char* fault :
       {"r.json: speed: unknown key", "optimizer.batch: expected a whole number", "optimizer.rate",
        "variant.prior_kind: expected one of"}) {
    EXPECT_NE(text.find(fault), std::string::npos) << text;
  }
}

TEST(Recipe, WhatIsNoJsonIsRefused) {
  const auto recipe = parse_recipe("{", "r.json");
  ASSERT_FALSE(recipe);
  EXPECT_EQ(recipe.error().code, ErrorCode::kBadInput);
}

}  // namespace
}  // namespace flowdlo::train
