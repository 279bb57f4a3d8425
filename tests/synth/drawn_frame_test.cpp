#include "synth/drawn_frame.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace flowdlo::synth {
namespace {

TEST(DrawnFrame, IsTheSceneOfItsKindAndSeed) {
  const auto frame = make_frame(Split::kDrawn, Part::kValidation, 0, 2 * lab::kKinds + 2);
  ASSERT_TRUE(frame) << frame.error().message;
  const auto scene = lab::make_scene(lab::Kind::kOneCrossing, kFirstDrawnValidation + 2);
  EXPECT_EQ(frame->folder.mask, scene.image.mask);
  EXPECT_EQ(frame->truth(), scene.truth);
  EXPECT_EQ(frame->meta.scenario, "one-crossing");
  EXPECT_EQ(frame->meta.crossings, 1);
  EXPECT_EQ(frame->meta.split, "drawn");
  EXPECT_EQ(frame->folder.name, "000024_one-crossing");
  for (std::size_t i = 0; i < scene.image.depth_m.size(); ++i) {
    ASSERT_NEAR(frame->folder.depth_m[i], scene.image.depth_m[i], kDepthScale_m);
  }
}

TEST(DrawnFrame, PartsShareNoScene) {
  const auto training = make_frame(Split::kDrawn, Part::kTraining, 0, 0, {.color = false});
  const auto validation = make_frame(Split::kDrawn, Part::kValidation, 0, 0, {.color = false});
  ASSERT_TRUE(training && validation);
  EXPECT_NE(training->truth(), validation->truth());
  EXPECT_TRUE(training->folder.color_bgr.empty());
  EXPECT_FALSE(make_frame(Split::kDrawn, Part::kTraining, 0, kFirstDrawnValidation * lab::kKinds));
}

TEST(DrawnFrame, ThereIsOneFrameOfAScene) {
  EXPECT_FALSE(make_frame(Split::kDrawn, Part::kTraining, 0, 0, {.frame = 1}));
}

}  // namespace
}  // namespace flowdlo::synth
