#include "eval/trial_json.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "eval/draws.hpp"
#include "eval/tables.hpp"
#include "eval/trials.hpp"

namespace flowdlo::eval {
namespace {

using testing::HasSubstr;

// A value in every field, none of them a round number.
Trial full_trial() {
  Trial trial = test::trial("scène, \"1\"\n", 4.0 / 3, 1.0 / 7, 2.0 / 3, 0.1);
  trial.scene = {"C-shape", "red", {"gap", "coil"}, true, 3};
  trial.confidence = 0.1 + 0.2;
  trial.mask_agreement = 1.0 / 3;
  trial.total_ms = 117.3;
  trial.sigma = {2.0 / 3, 0.95};
  trial.folder = "sets/wide/one";
  trial.data_set = "wide";
  trial.accounts["mbest"] = {"mask holds no line", false, 1, 0, 0};
  trial.accounts["full"] = {"", true, 4, 3, 2.0 / 3};
  for (std::size_t i = 0; i < kNodes; ++i) {
    const float at = static_cast<float>(i);
    trial.nodes[i] = {at / 3, std::sin(at), 1 / (at + 1)};
    trial.truth[i] = {at / 7, std::cos(at), 1 / (at + 3)};
  }
  trial.curves["full"] = {kept(trial.nodes), kept(trial.truth)};
  return trial;
}

TEST(TrialJson, ComesBackToTheLastBit) {
  const Trial trial = full_trial();
  const auto row = parse_row(row_json({17, trial}), "rows");
  ASSERT_TRUE(row) << row.error().message;
  EXPECT_EQ(row->index, 17U);
  EXPECT_EQ(row->trial.name, trial.name);
  EXPECT_EQ(row->trial.nodes, trial.nodes);
  EXPECT_EQ(row->trial.truth, trial.truth);
  EXPECT_EQ(row->trial.confidence, trial.confidence);
  EXPECT_EQ(row->trial.total_ms, trial.total_ms);
  EXPECT_EQ(row->trial.scene.defects, trial.scene.defects);
  EXPECT_EQ(row->trial.source, trial.source);
  EXPECT_EQ(row->trial.folder, trial.folder);
  EXPECT_EQ(row->trial.data_set, trial.data_set);
  EXPECT_EQ(row->trial.curves, trial.curves);
  EXPECT_EQ(row->trial.accounts.at("mbest").failure, "mask holds no line");
  EXPECT_EQ(row->trial.accounts.at("full").mask_agreement, 2.0 / 3);
  EXPECT_EQ(row_json(*row), row_json({17, trial}));
}

TEST(TrialJson, TablesOfWhatCameBackAreThoseOfWhatWent) {
  const std::vector<Trial> went{full_trial(), test::trial("b", 6, 3, 4, 1.5)};
  std::vector<Trial> came;
  for (const Trial& trial : went) {
    auto row = parse_row(row_json({0, trial}), "rows");
    ASSERT_TRUE(row);
    came.push_back(row->trial);
  }
  EXPECT_EQ(tables_markdown(came), tables_markdown(went));
  EXPECT_EQ(rows_csv(came), rows_csv(went));
}

TEST(TrialJson, IsOneLine) { EXPECT_EQ(row_json({0, full_trial()}).find('\n'), std::string::npos); }

TEST(TrialJson, NumberThatIsNoneComesBackAsNone) {
  Trial trial = full_trial();
  trial.confidence = std::numeric_limits<double>::quiet_NaN();
  trial.nodes[3].y = std::numeric_limits<float>::infinity();
  const auto row = parse_row(row_json({0, trial}), "rows");
  ASSERT_TRUE(row);
  EXPECT_TRUE(std::isnan(row->trial.confidence));
  EXPECT_TRUE(std::isnan(row->trial.nodes[3].y));
}

TEST(TrialJson, TextThatIsNoRowIsNamed) {
  const std::string half = row_json({0, full_trial()}).substr(0, 300);
  for (const std::string& line : {std::string(), std::string("{}"), std::string("[1, 2]"), half,
                                  std::string("{\"row\": \"x\"}")}) {
    const auto row = parse_row(line, "rows.jsonl:4");
    ASSERT_FALSE(row) << line;
    EXPECT_THAT(row.error().message, HasSubstr("rows.jsonl:4: expected a row"));
  }
}

}  // namespace
}  // namespace flowdlo::eval
