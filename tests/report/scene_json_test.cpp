#include "report/scene_json.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <vector>

#include "report/curled_trial.hpp"

namespace flowdlo::report {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(SceneJson, CurvesAreWholeTenthsOfAMillimetre) {
  const std::vector<eval::Trial> trials{test::curled_trial("one")};
  const auto json = nlohmann::json::parse(scenes_json(trials));
  const auto& scene = json["sets"][0]["scenes"][0];
  ASSERT_EQ(scene["curves"]["truth"][0].size(), 3U * kNodes);
  EXPECT_NEAR(scene["curves"]["truth"][0][2].get<double>() * json["unit_m"].get<double>(), 0.5,
              1e-3);
  EXPECT_EQ(scene["curves"]["model"].size(), 2U);
}

TEST(SceneJson, FramesWithoutACurveAreLeftOut) {
  eval::Trial failed;
  failed.name = "bad";
  failed.failure = "no path";
  const auto json = nlohmann::json::parse(scenes_json(std::vector<eval::Trial>{failed}));
  EXPECT_TRUE(json["sets"].empty());
}

TEST(SceneJson, NamesCannotEndTheScript) {
  const std::vector<eval::Trial> trials{test::curled_trial("</script><b>")};
  EXPECT_THAT(scenes_json(trials), Not(HasSubstr("</")));
  const auto json = nlohmann::json::parse(scenes_json(trials));
  EXPECT_EQ(json["sets"][0]["scenes"][0]["name"], "</script><b>");
}

}  // namespace
}  // namespace flowdlo::report
