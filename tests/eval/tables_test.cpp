#include "eval/tables.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "eval/trials.hpp"

namespace flowdlo::eval {
namespace {

using testing::HasSubstr;
using testing::Not;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST(Tables, MeansStandInTheirColumns) {
  const std::vector<Trial> trials{test::trial("a", 4, 1, 2, 0.5), test::trial("b", 6, 3, 4, 1.5)};
  const std::string tables = tables_markdown(trials);
  // Frechet distances are twice the index errors here.
  EXPECT_THAT(tables, HasSubstr("| all | 2 | 5.000 / 10.000 | 2.000 / 4.000 | 3.000 / 6.000 | "
                                "1.000 / 2.000 | 1.000 / 2.000 |"));
}

TEST(Tables, RatioIsOfTheMeans) {
  const std::vector<Trial> trials{test::trial("a", 4, 1, 2, 0.5), test::trial("b", 6, 3, 4, 1.5)};
  EXPECT_THAT(tables_markdown(trials),
              HasSubstr("| 1.500 [1.333, 2.000] | 0.500 [0.500, 0.500] |"));
}

TEST(Tables, GroupsByScenarioAndDifficulty) {
  std::vector<Trial> trials{test::trial("a", 4, 1, 2, 0.5), test::trial("b", 6, 3, 4, 1.5)};
  trials[0].scene.scenario = "C-shape";
  trials[0].scene.described = true;
  trials[1].scene.scenario = "coil";
  trials[1].scene.defects.insert("coil");
  const std::string tables = tables_markdown(trials);
  EXPECT_THAT(tables, HasSubstr("| easy (no crossing, gap or bad depth) | 1 | 4.000"));
  EXPECT_THAT(tables, HasSubstr("| hard (gap, touch, coil or holes) | 1 | 6.000"));
  EXPECT_THAT(tables, HasSubstr("| C-shape | 1 |"));
  EXPECT_THAT(tables, HasSubstr("| coil | 1 |"));
}

TEST(Tables, FailedFrameCostsItsRowOnlyAndIsNamed) {
  std::vector<Trial> trials{test::trial("good", 4, 1, 2, 0.5)};
  Trial failed;
  failed.name = "bad";
  failed.failure = "depth.png: expected depths, got none";
  trials.push_back(failed);
  const std::string tables = tables_markdown(trials);
  EXPECT_THAT(tables, HasSubstr("1 of 2 frames have an estimate"));
  EXPECT_THAT(tables, HasSubstr("- bad: depth.png"));
  EXPECT_THAT(tables, HasSubstr("| all | 1 |"));
}

TEST(Tables, FramesWithoutTruthAreCoveredButNotMeasured) {
  Trial real;
  real.name = "real";
  real.draws = 4;
  const std::string tables = tables_markdown(std::vector<Trial>{real});
  EXPECT_THAT(tables, HasSubstr("1 of 1 frames have an estimate, 0 have a truth"));
  EXPECT_THAT(tables, Not(HasSubstr("## Errors")));
}

TEST(Tables, CalibrationComparesWhatWasSaidWithWhatWas) {
  std::vector<Trial> trials;
  for (int i = 0; i < 10; ++i) {  // all say 0.9, half are close
    trials.push_back(test::trial("a", 4, 1, 2, i % 2 == 0 ? 0.5 : 5));
  }
  const std::string tables = tables_markdown(trials);
  EXPECT_THAT(tables, HasSubstr("| 0.90 | 10 | 50.0 % |"));
  EXPECT_THAT(tables, HasSubstr("Expected calibration error 0.400"));
}

TEST(Tables, SayThatTheScenesDiffer) {
  EXPECT_THAT(tables_markdown({}), HasSubstr("not those of the thesis"));
}

TEST(Tables, EveryRowHasTheHeadersColumns) {
  std::vector<Trial> trials{test::trial("a", 4, 1, 2, 0.5)};
  Trial failed;
  failed.name = "bad";
  failed.failure = "no mask";
  trials.push_back(failed);
  const auto lines = lines_of(rows_csv(trials));
  ASSERT_EQ(lines.size(), 3U);
  const auto commas = [](const std::string& line) {
    return std::count(line.begin(), line.end(), ',');
  };
  EXPECT_EQ(commas(lines[0]), commas(lines[1]));
  EXPECT_EQ(commas(lines[0]), commas(lines[2]));
}

TEST(Tables, CommaInAFailureIsQuoted) {
  Trial failed;
  failed.name = "bad";
  failed.failure = "expected \"a\", got b";
  EXPECT_THAT(rows_csv(std::vector<Trial>{failed}), HasSubstr("\"expected \"\"a\"\", got b\""));
}

}  // namespace
}  // namespace flowdlo::eval
