#include "eval/coverage_tables.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "eval/scenes.hpp"

namespace flowdlo::eval {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

TEST(AvailabilityTable, CountsTheReasons) {
  const std::vector<Trial> trials{test::scene("a", "C"), test::scene_without_baseline("b", "C"),
                                  test::scene_without_baseline("c", "C")};
  EXPECT_THAT(
      availability_table(data_sets_of(trials)[0]),
      HasSubstr("| trackdlo | 3 | 1 | 0 | 2 | 75.0 % | 6.000 / 12.000 | 0.0 % | 2 x cost of "
                "two tips is not a number |"));
}

TEST(AvailabilityTable, OutputThatFailsTheChecksIsInvalid) {
  std::vector<Trial> trials{test::scene_without_baseline("a", "C")};
  trials[0].accounts["trackdlo"].output = true;
  EXPECT_THAT(availability_table(data_sets_of(trials)[0]),
              HasSubstr("| trackdlo | 1 | 0 | 1 | 0 |"));
}

TEST(RecordingTable, IsOfTheFramesWithoutTruth) {
  const std::vector<Trial> trials{test::real_frame("a"), test::real_frame("b")};
  const std::string table = recording_table(data_sets_of(trials)[0]);
  EXPECT_THAT(table, HasSubstr("| set | 2 | 2 / 0 / 0 | 2 of 2 | 6 of 8 | 75.0 % | 90.0 % | 95.0 % "
                               "| 100.0 % |"));
  EXPECT_THAT(table, HasSubstr("*0 of 80*"));
  const std::vector<Trial> synthetic{test::scene("a", "C")};
  EXPECT_THAT(recording_table(data_sets_of(synthetic)[0]), IsEmpty());
}

TEST(FrameTable, SaysWhyThereIsNothing) {
  std::vector<Trial> trials{test::real_frame("a")};
  trials[0].accounts["trackdlo"] = {"mask is empty", false, 1, 0, 0};
  EXPECT_THAT(frame_table(data_sets_of(trials)[0]), HasSubstr("no output: mask is empty"));
}

TEST(Reliability, BinsHoldWhatWasSaidAndWhatWas) {
  std::vector<Trial> trials;
  for (int i = 0; i < 4; ++i) {
    trials.push_back(test::scene("a", "C"));
    trials.back().confidence = i < 2 ? 0.82 : 0.15;
    if (i == 3) trials.back().methods["estimate"].either_index_m = 0.05;
  }
  const auto bins = reliability(data_sets_of(trials)[0].trials);
  ASSERT_THAT(bins, SizeIs(2));
  EXPECT_NEAR(bins[0].said, 0.15, 1e-9);
  EXPECT_NEAR(bins[0].was, 0.5, 1e-9);
  EXPECT_NEAR(bins[1].was, 1.0, 1e-9);
  EXPECT_NEAR(expected_calibration_error(bins), (0.35 + 0.18) / 2, 1e-9);
}

TEST(Reliability, OfNothingIsNothing) {
  EXPECT_THAT(reliability({}), IsEmpty());
  EXPECT_EQ(expected_calibration_error({}), 0);
}

}  // namespace
}  // namespace flowdlo::eval
