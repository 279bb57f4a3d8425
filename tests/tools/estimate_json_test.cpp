#include "estimate_json.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tools/sample_estimate.hpp"

namespace flowdlo::tools {
namespace {

using Json = nlohmann::json;
using testing::HasSubstr;

const Provenance kProvenance{"rope", "cpu", "", 10, 2, 18446744073709551615ULL};

TEST(EstimateJson, HasTheFieldsOfTheContract) {
  const auto json = Json::parse(estimate_json(test::sample_estimate(), kProvenance));
  EXPECT_EQ(json["status"], "ok");
  EXPECT_EQ(json["source"], "prediction");
  EXPECT_EQ(json["draw"], 1);
  EXPECT_EQ(json["device"], "cpu");
  EXPECT_TRUE(json["field_device"].is_null()) << "there is no strand field";
  Provenance with_field = kProvenance;
  with_field.field_device = "a GPU";
  EXPECT_EQ(Json::parse(estimate_json(test::sample_estimate(), with_field))["field_device"],
            "a GPU");
  EXPECT_EQ(json["frame"], "rope");
  EXPECT_EQ(json["seed"].get<std::uint64_t>(), kProvenance.seed);
  EXPECT_EQ(json["draws"].size(), 2U);
  EXPECT_EQ(json["draws"][1]["accepted"], true);
  EXPECT_DOUBLE_EQ(json["draws"][0]["length_ratio"], 2.5);
  EXPECT_DOUBLE_EQ(json["draws"][0]["max_segment_share"], 0.2);
  EXPECT_DOUBLE_EQ(json["draws"][0]["mask_agreement"], 0.4);
  EXPECT_EQ(json["support"].size(), 64U);
  EXPECT_EQ(json["support"][19], 1);
  EXPECT_EQ(json["support"][20], 0);
  EXPECT_EQ(json["sigma_m"].size(), 64U);
  EXPECT_DOUBLE_EQ(json["sigma_m"][0], 0.002);
  EXPECT_DOUBLE_EQ(json["confidence"], 0.8);
  EXPECT_DOUBLE_EQ(json["mask_agreement"], 0.95);
  EXPECT_DOUBLE_EQ(json["prior_mask_agreement"], 0.9);
  EXPECT_EQ(json["readings"], 5);
  EXPECT_EQ(json["alternatives"][0]["nodes_m"].size(), 64U);
  EXPECT_DOUBLE_EQ(json["alternatives"][0]["score"], 0.5);
  EXPECT_DOUBLE_EQ(json["timings_ms"]["model"], 12.0);
  EXPECT_DOUBLE_EQ(json["timings_ms"]["total"], 20.0);
  EXPECT_DOUBLE_EQ(json["device_timings_ms"]["step"], 9.0);
}

TEST(EstimateJson, SaysOfAModelThatWasNotAskedThatItWasNot) {
  auto estimate = test::sample_estimate();
  estimate.source = Source::kPrior;
  estimate.origin = Origin::kFirstPrior;
  estimate.calibrated = true;
  auto json = Json::parse(estimate_json(estimate, kProvenance));
  EXPECT_THAT(json["message"].get<std::string>(), HasSubstr("preferred the first prior to every"));
  estimate.draws.clear();
  json = Json::parse(estimate_json(estimate, kProvenance));
  EXPECT_THAT(json["message"].get<std::string>(),
              HasSubstr("the model was not asked, and the first prior was taken"));
}

TEST(EstimateJson, HoldsTheNodesAndWhatTheHintsDid) {
  auto estimate = test::sample_estimate();
  auto json = Json::parse(estimate_json(estimate, kProvenance));
  ASSERT_EQ(json["nodes_m"].size(), 64U);
  EXPECT_EQ(json["nodes_m"][0], (Json{-0.15, 0.0, 0.5}));
  EXPECT_EQ(json["reversed"], false);
  EXPECT_EQ(json["switched"], false);
  estimate.reversed = true;
  EXPECT_EQ(Json::parse(estimate_json(estimate, kProvenance))["reversed"], true);
  estimate.switched = true;
  EXPECT_EQ(Json::parse(estimate_json(estimate, kProvenance))["switched"], true);
}

TEST(EstimateJson, NamesTheCandidateThatWasReturned) {
  auto estimate = test::sample_estimate();
  estimate.source = Source::kPrior;
  estimate.calibrated = true;
  const std::vector<std::pair<Origin, std::pair<const char*, const char*>>> all{
      {Origin::kFirstPrior, {"first_prior", "the first prior"}},
      {Origin::kRunnerUp, {"runner_up", "runner-up"}},
      {Origin::kOtherReading, {"other_reading", "another reading"}},
      {Origin::kFrameBefore, {"frame_before", "the frame before"}}};
  for (const auto& [origin, names] : all) {
    estimate.origin = origin;
    const auto json = Json::parse(estimate_json(estimate, kProvenance));
    EXPECT_EQ(json["origin"], names.first);
    EXPECT_THAT(json["message"].get<std::string>(), testing::HasSubstr(names.second));
  }
  estimate.source = Source::kPrediction;
  estimate.origin = Origin::kDraw;
  EXPECT_EQ(Json::parse(estimate_json(estimate, kProvenance))["origin"], "draw");
}

TEST(EstimateJson, NamesTheGateThatGivesConfidenceItsMeaning) {
  auto estimate = test::sample_estimate();
  EXPECT_EQ(Json::parse(estimate_json(estimate, kProvenance))["gate"], "thesis");
  estimate.calibrated = true;
  EXPECT_EQ(Json::parse(estimate_json(estimate, kProvenance))["gate"], "calibrated");
}

TEST(EstimateJson, SaysWhyConfidenceIsLow) {
  auto estimate = test::sample_estimate();
  EXPECT_TRUE(Json::parse(estimate_json(estimate, kProvenance))["one_rope"]["doubts"].empty());
  estimate.one_rope.doubts = {Doubt::kNoRope, Doubt::kStrandsLeft, Doubt::kBareGap, Doubt::kGoesOn,
                              Doubt::kNoDepth};
  estimate.one_rope.explained = 0.5F;
  estimate.one_rope.goes_on = 7.5F;
  const auto one = Json::parse(estimate_json(estimate, kProvenance))["one_rope"];
  EXPECT_EQ(one["doubts"],
            Json::parse(R"(["no_rope", "strands_left", "bare_gap", "goes_on", "no_depth"])"));
  EXPECT_DOUBLE_EQ(one["explained"], 0.5);
  EXPECT_DOUBLE_EQ(one["goes_on"], 7.5);
}

TEST(EstimateJson, PriorHasNoDraw) {
  auto estimate = test::sample_estimate();
  estimate.source = Source::kPrior;
  estimate.draw = -1;
  const auto json = Json::parse(estimate_json(estimate, kProvenance));
  EXPECT_EQ(json["source"], "prior");
  EXPECT_TRUE(json["draw"].is_null());
  EXPECT_THAT(json["message"], HasSubstr("prior"));
}

TEST(EstimateJson, NumbersThatAreNotFiniteAreNull) {
  auto estimate = test::sample_estimate();
  estimate.draws[0].length_ratio = std::numeric_limits<float>::quiet_NaN();
  estimate.draws[0].mask_agreement = std::numeric_limits<float>::infinity();
  estimate.confidence = std::numeric_limits<float>::quiet_NaN();
  const auto text = estimate_json(estimate, kProvenance);
  ASSERT_TRUE(Json::accept(text)) << text;
  const auto json = Json::parse(text);
  EXPECT_TRUE(json["draws"][0]["length_ratio"].is_null());
  EXPECT_TRUE(json["draws"][0]["mask_agreement"].is_null());
  EXPECT_TRUE(json["confidence"].is_null());
}

TEST(EstimateJson, FailureHasTheCodesNameAndTheSentence) {
  const auto json =
      Json::parse(failure_json({ErrorCode::kNoEvidence, "Frame: nothing to see"}, kProvenance));
  EXPECT_EQ(json["status"], "no_evidence");
  EXPECT_EQ(json["message"], "Frame: nothing to see");
  EXPECT_EQ(json["device"], "cpu");
}

TEST(EstimateJson, BytesThatAreNoTextDoNotBreakIt) {
  const auto text = failure_json({ErrorCode::kIo, "\xFF\xFE/depth.png: none"}, kProvenance);
  EXPECT_TRUE(Json::accept(text));
}

TEST(RopesJson, TopLevelIsTheFirstRopesAndEachRopeHasTheFieldsOfTheContract) {
  const auto json = Json::parse(ropes_json({test::sample_ropes(), {}, {}}, kProvenance));
  EXPECT_EQ(json["status"], "ok");
  EXPECT_EQ(json["closed"], false);
  EXPECT_DOUBLE_EQ(json["confidence"], 0.8);
  ASSERT_EQ(json["ropes"].size(), 2U);
  for (const auto& rope : json["ropes"]) {
    EXPECT_EQ(rope["nodes"].size(), 64U);
    EXPECT_EQ(rope["nodes"][0].size(), 3U);
    EXPECT_EQ(rope["support"].size(), 64U);
    EXPECT_EQ(rope["sigma_m"].size(), 64U);
    EXPECT_EQ(rope["source"], "prediction");
    EXPECT_DOUBLE_EQ(rope["confidence"], 0.8);
  }
  EXPECT_EQ(json["ropes"][0]["closed"], false);
  EXPECT_EQ(json["ropes"][1]["closed"], true);
  EXPECT_NEAR(json["ropes"][1]["nodes"][0][1], -0.1, 1e-6);
}

TEST(RopesJson, OfAStreamHasTheNumbersThatRopesKeep) {
  const auto json = Json::parse(ropes_json({test::sample_ropes(), {2, 5}, {1, 4}}, kProvenance));
  EXPECT_EQ(json["ropes"][0]["number"], 2);
  EXPECT_EQ(json["ropes"][1]["number"], 5);
  EXPECT_EQ(json["missing"], Json::array({1, 4}));
  const auto alone = Json::parse(ropes_json({test::sample_ropes(), {}, {}}, kProvenance));
  EXPECT_FALSE(alone["ropes"][0].contains("number"));
  EXPECT_FALSE(alone.contains("missing"));
}

TEST(RopesJson, ACrossingIsToldOfByBothOfItsRopes) {
  const auto json = Json::parse(ropes_json({test::sample_ropes(), {}, {}}, kProvenance));
  const auto& below = json["ropes"][0]["crossings"];
  const auto& above = json["ropes"][1]["crossings"];
  ASSERT_EQ(below.size(), 1U);
  ASSERT_EQ(above.size(), 1U);
  EXPECT_EQ(below[0]["rope"], 1);
  EXPECT_EQ(below[0]["over"], false);
  EXPECT_NEAR(below[0]["at_m"], 0.15, 1e-6);
  EXPECT_EQ(above[0]["rope"], 0);
  EXPECT_EQ(above[0]["over"], true);
  EXPECT_NEAR(above[0]["at_m"], 0.1, 1e-6);
  EXPECT_NEAR(above[0]["other_at_m"], 0.15, 1e-6);
}

}  // namespace
}  // namespace flowdlo::tools
