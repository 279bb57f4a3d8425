#include "eval/thesis_figures.hpp"

#include <gtest/gtest.h>

#include <string>

namespace flowdlo::eval {
namespace {

// Mean over scenes of a figure of the nine groups.
template <class Figure>
double overall(const Figure& figure) {
  double sum = 0;
  for (const ThesisRow& row : thesis_rows()) {
    if (std::string(row.scenario) != "all") sum += row.scenes * figure(row) / 59;
  }
  return sum;
}

TEST(ThesisFigures, GroupsAddUpToTheOverallRow) {  // figures have three decimals
  const ThesisRow& all = *thesis_row("all");
  EXPECT_NEAR(overall([](const ThesisRow& row) { return row.prior.index_cm; }), all.prior.index_cm,
              1e-3);
  EXPECT_NEAR(overall([](const ThesisRow& row) { return row.prior.frechet_cm; }),
              all.prior.frechet_cm, 1e-3);
  EXPECT_NEAR(overall([](const ThesisRow& row) { return row.without_points.index_cm; }),
              all.without_points.index_cm, 1e-3);
  EXPECT_NEAR(overall([](const ThesisRow& row) { return row.full.frechet_cm; }),
              all.full.frechet_cm, 1e-3);
  EXPECT_NEAR(overall([](const ThesisRow& row) { return row.residual.index_cm; }),
              all.residual.index_cm, 1e-3);
  EXPECT_NEAR(overall([](const ThesisRow& row) { return row.prediction_cm; }), all.prediction_cm,
              1e-3);
  EXPECT_NEAR(overall([](const ThesisRow& row) { return row.hybrid_cm; }), all.hybrid_cm, 1e-3);
}

TEST(ThesisFigures, OutputsAddUpToTheScenes) {
  int valid = 0;
  for (const ThesisRow& row : thesis_rows()) {
    EXPECT_EQ(row.valid + row.no_output + row.invalid, row.scenes) << row.scenario;
    valid += std::string(row.scenario) == "all" ? 0 : row.valid;
  }
  EXPECT_EQ(valid, 31);
}

TEST(ThesisFigures, RecordingsAddUpToTheirFrames) {
  for (const ThesisRecording& row : thesis_recordings()) {
    EXPECT_EQ(row.valid + row.no_output + row.invalid, row.frames) << row.name;
  }
}

TEST(ThesisFigures, OtherGroupsAreUnknown) { EXPECT_EQ(thesis_row("hairpin"), nullptr); }

}  // namespace
}  // namespace flowdlo::eval
