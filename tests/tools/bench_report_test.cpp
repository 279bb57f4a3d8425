#include "bench_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace flowdlo::tools {
namespace {

using Json = nlohmann::json;

BenchReport three_frames() {
  BenchReport report;
  report.frame = "wave";
  report.device = "cpu";
  report.threads = 2;
  report.create_ms = 12.5;
  for (const double factor : {3.0, 1.0, 2.0}) {
    Timings timings;
    timings.path_ms = factor;
    timings.model_ms = 10 * factor;
    timings.total_ms = 11 * factor;
    timings.device_ms = {{"points", 4 * factor}, {"attention", 5 * factor}};
    report.timings.push_back(timings);
  }
  return report;
}

TEST(Percentiles, AreLinearBetweenTheNearestRanks) {
  const auto percentiles = percentiles_of({4.0, 1.0, 3.0, 2.0, 5.0});
  EXPECT_DOUBLE_EQ(percentiles.p50, 3.0);
  EXPECT_DOUBLE_EQ(percentiles.p95, 4.8);
  EXPECT_DOUBLE_EQ(percentiles.p99, 4.96);
  EXPECT_DOUBLE_EQ(percentiles.most, 5.0);
}

TEST(Percentiles, OfOneValueAreThatValueAndOfNoneZero) {
  EXPECT_DOUBLE_EQ(percentiles_of({7.0}).p99, 7.0);
  EXPECT_DOUBLE_EQ(percentiles_of({}).p50, 0.0);
}

TEST(BenchReport, JsonHasTheFieldsOfTheContract) {
  const auto json = Json::parse(bench_json(three_frames()));
  EXPECT_EQ(json["device"], "cpu");
  EXPECT_TRUE(json["field_device"].is_null()) << "there is no strand field";
  BenchReport elsewhere = three_frames();
  elsewhere.field_device = "a GPU";
  EXPECT_EQ(Json::parse(bench_json(elsewhere))["field_device"], "a GPU");
  EXPECT_NE(bench_table(elsewhere).find("strand field on a GPU"), std::string::npos);
  EXPECT_EQ(json["threads"], 2);
  EXPECT_DOUBLE_EQ(json["create_ms"], 12.5);
  EXPECT_TRUE(json["first_ms"].is_number());
  EXPECT_TRUE(json["rss_mb"].is_number());
  EXPECT_DOUBLE_EQ(json["total_ms"]["p50"], 22.0);
  for (const char* stage : {"path", "evidence", "prior", "mask_field", "model", "gate"}) {
    for (const char* percentile : {"p50", "p95", "p99"}) {
      EXPECT_TRUE(json["stages_ms"][stage][percentile].is_number()) << stage << percentile;
    }
  }
  EXPECT_DOUBLE_EQ(json["stages_ms"]["path"]["p50"], 2.0);
  EXPECT_DOUBLE_EQ(json["device_stages_ms"]["attention"]["p50"], 10.0);
}

TEST(BenchReport, TableNamesEveryStageAndTheDevicesOwn) {
  const auto table = bench_table(three_frames());
  for (const char* word : {"path", "evidence", "prior", "mask_field", "model", "gate", "total",
                           "attention", "p95", "2 threads"}) {
    EXPECT_THAT(table, testing::HasSubstr(word));
  }
}

}  // namespace
}  // namespace flowdlo::tools
