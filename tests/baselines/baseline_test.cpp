#include "baselines/baseline.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "baselines/drawn.hpp"
#include "eval/metrics.hpp"

namespace flowdlo::baselines {
namespace {

using testing::HasSubstr;
using testing::SizeIs;

TEST(Baseline, AllNamesEveryOne) {
  const auto chosen = choose_baselines({"all"});
  ASSERT_TRUE(chosen);
  EXPECT_THAT(*chosen, SizeIs(all_baselines().size()));
}

TEST(Baseline, NamedTwiceRunsOnce) {
  const auto chosen = choose_baselines({"mbest", "trackdlo-init", "trackdlo", "prior"});
  ASSERT_TRUE(chosen);
  EXPECT_THAT(*chosen, SizeIs(2));
}

TEST(Baseline, UnknownNamesAreAllListed) {
  const auto chosen = choose_baselines({"mbest", "magic", "luck"});
  ASSERT_FALSE(chosen);
  EXPECT_THAT(chosen.error().message, HasSubstr("\"magic\" \"luck\""));
}

TEST(Baseline, EachLiftsAPlainRopeToItsLength) {
  std::vector<cv::Point> points;
  for (int i = 0; i <= 60; ++i) {
    points.emplace_back(40 + 4 * i, 170 - cvRound(90 * std::sin(3.1415927 * i / 60)));
  }
  const auto seen = test::observation(test::drawn(points, 11));
  Centerline truth{};
  for (std::size_t i = 0; i < kNodes; ++i) {
    const double u = 40 + 240.0 * static_cast<double>(i) / (kNodes - 1);
    const double v = 170 - 90 * std::sin(3.1415927 * static_cast<double>(i) / (kNodes - 1));
    truth[i] = {static_cast<float>((u - 160) / 600), static_cast<float>((v - 120) / 600), 0.5F};
  }
  for (const Baseline& baseline : all_baselines()) {
    const Attempt attempt = baseline.run(seen);
    if (attempt.status == Status::kNoOutput) {  // the faithful TrackDLO-init may
      EXPECT_STREQ(baseline.name, "trackdlo") << attempt.reason;
      continue;
    }
    EXPECT_LT(eval::score(attempt.nodes, truth).either_index_m, 0.025) << baseline.name;
  }
}

TEST(Baseline, EmptyMasksGiveNoOutputAndAReason) {
  for (const Baseline& baseline : all_baselines()) {
    const Attempt attempt = baseline.run(test::observation(test::blank()));
    EXPECT_EQ(attempt.status, Status::kNoOutput) << baseline.name;
    EXPECT_FALSE(attempt.reason.empty()) << baseline.name;
  }
}

}  // namespace
}  // namespace flowdlo::baselines
