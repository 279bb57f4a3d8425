#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "synth/synthetic_frame.hpp"

namespace flowdlo::synth {
namespace {

TEST(MetaJson, HoldsEveryFieldOfARealFrame) {
  const auto frame = make_frame(Split::kWide, Part::kValidation, 11, 3, {.color = false});
  ASSERT_TRUE(frame);
  const auto json = nlohmann::json::parse(meta_json(frame->meta));

  for (const char* name : {"scenario",       "material",     "hsv_band",
                           "radius_m",       "length_m",     "least_bend_radius_m",
                           "crossings",      "intersection", "hanging",
                           "square_ends",    "camera",       "distance_m",
                           "tilt_deg",       "occluders",    "defects",
                           "hard",           "easy",         "width_px",
                           "visible_share",  "depth_share",  "longest_gap_m",
                           "longest_hole_m", "split",        "part",
                           "seed",           "index",        "frame",
                           "cords",          "matched"}) {
    EXPECT_TRUE(json.contains(name)) << name;
  }
  EXPECT_EQ(json["defects"].size(), 18U);
  EXPECT_EQ(json["split"], "wide");
  EXPECT_EQ(json["part"], "validation");
  EXPECT_EQ(json["seed"], 11);
  EXPECT_EQ(json["index"], 3);
  EXPECT_EQ(json["scenario"], frame->meta.scenario);
  EXPECT_EQ(json["hsv_band"]["low"].size(), 3U);
  EXPECT_DOUBLE_EQ(json["radius_m"].get<double>(), frame->meta.radius_m);
}

TEST(MetaJson, NamesOfSplitsAndPartsAreReadBack) {
  for (const Split split :
       {Split::kThesis, Split::kWide, Split::kSeveral, Split::kDrawn, Split::kTangled}) {
    EXPECT_EQ(split_of(name_of(split)), split);
  }
  for (const Part part : {Part::kTraining, Part::kValidation}) {
    EXPECT_EQ(part_of(name_of(part)), part);
  }
  EXPECT_FALSE(split_of("narrow"));
}

}  // namespace
}  // namespace flowdlo::synth
