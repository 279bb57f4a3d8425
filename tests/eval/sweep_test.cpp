#include "eval/sweep.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flowdlo::eval {
namespace {

using ::testing::HasSubstr;

/// Frames of errors around 1 cm, each `factor` times as large.
Setting setting(int steps, int draws, double factor) {
  Setting result{steps, draws, {}, {}, {}};
  for (int i = 0; i < 40; ++i) {
    const double error_m = factor * (0.008 + 0.0001 * i);
    result.model_m.push_back(error_m);
    result.estimate_m.push_back(error_m);
    result.model_ms.push_back(steps * draws);
  }
  return result;
}

TEST(Sweep, CheapestIsTheOneOfFewestEvaluationsThatLosesNothing) {
  const std::vector<Setting> settings{setting(10, 4, 1), setting(4, 4, 1.0), setting(2, 1, 1.005),
                                      setting(1, 1, 1.05)};
  EXPECT_EQ(cheapest(settings), 2U);
}

TEST(Sweep, FullStaysWhereEverythingCheaperLoses) {
  EXPECT_EQ(cheapest(std::vector<Setting>{setting(10, 4, 1), setting(4, 4, 1.02)}), 0U);
}

TEST(Sweep, AnEstimateThatLosesCountsToo) {
  auto worse = setting(1, 1, 1);
  for (double& error_m : worse.estimate_m) error_m *= 1.1;
  EXPECT_EQ(cheapest(std::vector<Setting>{setting(10, 4, 1), worse}), 0U);
}

TEST(Sweep, TableEndsWithTheCommandThatSetsTheCheapest) {
  const std::vector<Setting> settings{setting(10, 4, 1), setting(2, 1, 1)};
  const auto table = sweep_markdown(settings);
  EXPECT_THAT(table, HasSubstr("| 2 | 1 | 0.995 (1.000 [1.000, 1.000])"));
  EXPECT_THAT(table, HasSubstr("set-fast FILE OUT --steps 2 --draws 1"));
}

TEST(Sweep, FullIsAlwaysAmongTheSettings) {
  const std::vector<int> steps{1, 10};
  const std::vector<int> draws{1, 4};
  EXPECT_EQ(settings_of(steps, draws), 4U);
  const std::vector<int> one{1};
  EXPECT_EQ(settings_of(one, one), 2U);
}

}  // namespace
}  // namespace flowdlo::eval
