#include "strand/recipe.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/source_dir.hpp"

namespace flowdlo::strand {
namespace {

using testing::HasSubstr;

TEST(FieldRecipe, TheRepositorysAreReadAndWriteThemselves) {
  for (const char* const name : {"field.json", "field_gpu.json", "field_ends.json"}) {
    const auto recipe = read_recipe(test::source_dir() / "lab/train/recipes" / name);
    ASSERT_TRUE(recipe) << recipe.error().message;
    const auto again = parse_recipe(to_json(*recipe), "again");
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_EQ(to_json(*again), to_json(*recipe));
  }
}

TEST(FieldRecipe, EveryFaultIsNamed) {
  const auto recipe = parse_recipe(
      R"({"name": "", "network": {"fine": 20}, "schedule": {"size_px": 100, "bach": 3}})", "here");
  ASSERT_FALSE(recipe);
  EXPECT_THAT(recipe.error().message, HasSubstr("here: name"));
  EXPECT_THAT(recipe.error().message, HasSubstr("multiples of 16"));
  EXPECT_THAT(recipe.error().message, HasSubstr("size_px: expected a multiple of 8, got 100"));
  EXPECT_THAT(recipe.error().message, HasSubstr("schedule.bach: unknown key"));
}

}  // namespace
}  // namespace flowdlo::strand
