#include "eval/chapter_tables.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "eval/scenes.hpp"

namespace flowdlo::eval {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

std::vector<Trial> two_scenes() {
  return {test::scene("a", "C"), test::scene_without_baseline("b", "intersection")};
}

TEST(DataSets, AreThoseOfTheFolders) {
  auto trials = two_scenes();
  trials[1].data_set = "other";
  const auto sets = data_sets_of(trials);
  ASSERT_EQ(sets.size(), 2U);
  EXPECT_EQ(sets[1].name, "other");
}

TEST(DataSets, GroupsComeInTheThesisOrderWithAllLast) {
  const std::vector<Trial> trials{test::scene("a", "intersection"), test::scene("b", "C")};
  std::vector<std::string> names;
  for (const auto& group : groups_of(data_sets_of(trials)[0])) names.push_back(group.name);
  EXPECT_THAT(names, ElementsAre("C", "intersection", "all"));
}

TEST(DataSets, OtherScenariosHaveNoThesisColumns) {
  const std::vector<Trial> trials{test::scene("a", "C"), test::scene("b", "hairpin")};
  const DataSet set = data_sets_of(trials)[0];
  EXPECT_FALSE(set.thesis_groups);
  EXPECT_THAT(conditioning_table(set), Not(HasSubstr("*")));
  EXPECT_THAT(verdict_table(set), IsEmpty());
}

TEST(CoverageTable, ErrorsAreOfTheScenesWhereAllAreValid) {
  const auto trials = two_scenes();
  const std::string table = coverage_table(data_sets_of(trials)[0], "trackdlo", "TrackDLO-init");
  EXPECT_THAT(table, HasSubstr("| intersection | 1 | 0 / 1 / 0 | - | - | - | *8 / 0 / 0* |"));
  EXPECT_THAT(table, HasSubstr("| all | 2 | 1 / 1 / 0 | 6.000 / 12.000 | 3.000 / 6.000 | 0.500 / "
                               "1.000 | *31 / 24 / 4* | *5.911 / 11.365* | *2.061 / 4.599* |"));
}

TEST(CoverageTable, BaselineThatWasNotRunHasNone) {
  const auto trials = two_scenes();
  EXPECT_THAT(coverage_table(data_sets_of(trials)[0], "mbest", "mBEST"), IsEmpty());
}

TEST(ConditioningTable, OursStandBesideTheThesis) {
  const auto trials = two_scenes();
  EXPECT_THAT(conditioning_table(data_sets_of(trials)[0]),
              HasSubstr("| C | 1 | 4.000 / 8.000 | 3.000 / 6.000 | 3.000 / 6.000 | 1.000 / 2.000 | "
                        "2.000 / 4.000 | 0.500 / 1.000 | *0.926 / 1.281* | *0.252 / 0.501* | "
                        "*0.222 / 0.463* |"));
}

TEST(SweepTable, StepsStandInTheirColumns) {
  auto trials = two_scenes();
  for (Trial& trial : trials) trial.methods["full@4"].index_m = 0.07;
  EXPECT_THAT(sweep_table(data_sets_of(trials)[0]),
              HasSubstr("| velocity | 3.000 | 7.000 | 3.000 | 3.000 | 6.000 |"));
}

TEST(GateTable, AcceptanceIsOfAllDraws) {
  const auto trials = two_scenes();
  EXPECT_THAT(gate_table(data_sets_of(trials)[0], "full"),
              HasSubstr("| all | 8 | 50.0 % | 3.000 | 4.000 | 2.000 | 2.000 | *61.4 %* | *3.055* | "
                        "*5.039* | *4.316* |"));
  EXPECT_THAT(gate_table(data_sets_of(trials)[0], ""), HasSubstr("| all | 8 | 75.0 % | 2.000 |"));
}

TEST(VerdictTable, SaysWhereOursIsSmaller) {
  auto trials = two_scenes();
  trials[0].methods["estimate"] = {0.002, 0.02, 0.002, 0, 0};  // 0.2 / 2 cm against 0.222 / 0.463
  const std::string table = verdict_table(data_sets_of(trials)[0]);
  EXPECT_THAT(table, HasSubstr("| 0.90, 4.32 | index error |"));
  EXPECT_THAT(table, HasSubstr("| 0.34, 0.48 | both |"));
}

}  // namespace
}  // namespace flowdlo::eval
