#include "baselines/observation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "baselines/drawn.hpp"
#include "frame/temporary_folder.hpp"

namespace flowdlo::baselines {
namespace {

using testing::HasSubstr;

Result<Observation> observed(const flowdlo::test::TemporaryFolder& folder, const char* meta) {
  std::ofstream(folder.path() / "meta.json") << meta;
  return observe(test::observation(test::blank()).folder, folder.path());
}

TEST(Observation, TakesTheThresholdsOfTheScene) {
  const flowdlo::test::TemporaryFolder folder;
  const auto seen =
      observed(folder, R"({"hsv_band": {"low": [100, 90, 25], "high": [120, 255, 255]}, "x": 1})");
  ASSERT_TRUE(seen) << seen.error().message;
  ASSERT_TRUE(seen->band);
  EXPECT_EQ(seen->band->low[0], 100);
}

TEST(Observation, WithoutThresholdsTheMaskStandsIn) {
  const flowdlo::test::TemporaryFolder folder;
  const auto seen = observed(folder, "{}");
  ASSERT_TRUE(seen);
  EXPECT_FALSE(seen->band);
  EXPECT_EQ(cv::countNonZero(hsv_mask(test::observation(test::drawn(test::loop(), 9)))),
            cv::countNonZero(test::drawn(test::loop(), 9)));
}

TEST(Observation, ThresholdsOfAnotherFormAreBadInput) {
  const flowdlo::test::TemporaryFolder folder;
  const auto seen = observed(folder, R"({"hsv_band": {"low": [1, 2], "high": [1, 2, 3]}})");
  ASSERT_FALSE(seen);
  EXPECT_THAT(seen.error().message, HasSubstr("hsv_band"));
}

TEST(Observation, BandCountsBothBorders) {
  Observation seen = test::observation(test::blank());
  seen.folder.color_bgr.assign(seen.folder.mask.size() * 3, 0);
  seen.folder.color_bgr[0] = 255;  // pure blue: hue 120
  seen.band = HsvBand{{120, 255, 255}, {120, 255, 255}};
  EXPECT_EQ(cv::countNonZero(hsv_mask(seen)), 1);
}

}  // namespace
}  // namespace flowdlo::baselines
