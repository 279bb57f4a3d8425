#include "eval/parts.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace flowdlo::eval {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

SceneInfo scene(double gap_widths, std::set<std::string> defects = {}) {
  SceneInfo info;
  info.described = true;
  info.gap_widths = gap_widths;
  info.defects = std::move(defects);
  return info;
}

/// Each frame's error in cm; hidden nodes are off by twice as much.
Part part(const std::string& name, std::vector<double> errors_cm) {
  Part result{name};
  for (const double cm : errors_cm) {
    result.outcomes.push_back({cm / 100, {cm / 50, cm / 50}, cm > 3, 10 * cm});
  }
  return result;
}

Parts three_scenes() {
  Parts parts;
  parts.scenes = {scene(0), scene(7, {"gap", "hidden_end"}), scene(13, {"gap", "touch"})};
  for (const char* name : {"a", "b", "c", "d"}) parts.parts.push_back(part(name, {2, 4, 6}));
  parts.parts.push_back(part("fast", {1, 2, 3}));
  return parts;
}

TEST(Parts, MeansAreTakenOverTheScenesOfEachGroup) {
  const auto table = parts_markdown(three_scenes());
  EXPECT_THAT(table, HasSubstr("all (3) | easy (1) | gap over 3 widths (2) | over 6 (2) | over 12 "
                               "(1) | an end hidden (1) | ambiguous"));
  EXPECT_THAT(table, HasSubstr("| fast | 2.000 | 1.000 | 2.500 | 2.500 | 3.000 | 2.000 | 3.000 |"));
}

TEST(Parts, AllButTheDefaultAreComparedWithIt) {
  const auto table = parts_markdown(three_scenes());
  EXPECT_THAT(table, HasSubstr("| a | 4.000 (2.00 [2.00, 2.00]) | 2.000 |"));
  EXPECT_THAT(table, Not(HasSubstr("| fast | 2.000 (")));
}

TEST(Parts, HiddenNodesDrawsAndTimesHaveColumns) {
  const auto table = parts_markdown(three_scenes());
  EXPECT_THAT(table, HasSubstr("| 8.000 | 2 of 3 | 40.0 |"));
  EXPECT_THAT(table, HasSubstr("| 4.000 | 0 of 3 | 20.0 |"));
}

}  // namespace
}  // namespace flowdlo::eval
