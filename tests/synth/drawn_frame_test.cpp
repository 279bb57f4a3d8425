#include "synth/drawn_frame.hpp"

#include <gtest/gtest.h>

#include <algorithm>
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

double px(const Intrinsics& camera, const Vector3d& p, int axis) {
  const double focal = static_cast<double>(axis == 0 ? camera.fx : camera.fy);
  return focal * p[axis] / p.z() + static_cast<double>(axis == 0 ? camera.cx : camera.cy);
}

/// Share of the curves' points in the image at which the ideal depth is that of a rope's surface.
double share_in_sight(const SyntheticFrame& frame) {
  const FrameFolder& folder = frame.folder;
  int inside = 0;
  int seen = 0;
  for (std::size_t k = 0; k < frame.dense->curves.size(); ++k) {
    const double radius_m = frame.ropes[k].radius_m;
    for (const Vector3d& p : frame.dense->curves[k].points) {
      const auto u = static_cast<int>(std::lround(px(folder.intrinsics, p, 0)));
      const auto v = static_cast<int>(std::lround(px(folder.intrinsics, p, 1)));
      if (u < 0 || v < 0 || u >= folder.width || v >= folder.height) continue;
      ++inside;
      const auto at = static_cast<std::size_t>(v * folder.width + u);
      seen += frame.dense->mask[at] != 0 &&
              std::abs(static_cast<double>(frame.dense->depth_m[at]) - p.z()) < 1.8 * radius_m;
    }
  }
  return static_cast<double>(seen) / inside;
}

TEST(DrawnFrame, ItsDenseTruthIsWhatACameraWithoutNoiseSees) {
  const auto plain = drawn_frame(lab::Kind::kOneCrossing, 5, /*dense=*/true);
  ASSERT_TRUE(plain.dense);
  ASSERT_EQ(plain.dense->curves.size(), 1U);
  EXPECT_GT(share_in_sight(plain), 0.9);
  const auto barred = drawn_frame(lab::Kind::kOccluder, 5, /*dense=*/true);
  EXPECT_LT(share_in_sight(barred), share_in_sight(plain));
  EXPECT_FALSE(drawn_frame(lab::Kind::kOneCrossing, 5).dense);
}

TEST(DrawnFrame, OfSeveralRopesKnowsEach) {
  const auto frame = drawn_ropes_frame(lab::RopesKind::kRings, 3, 4, /*dense=*/true);
  EXPECT_EQ(frame.meta.ropes, 3);
  ASSERT_EQ(frame.ropes.size(), 3U);
  ASSERT_EQ(frame.dense->curves.size(), 3U);
  EXPECT_TRUE(std::any_of(frame.ropes.begin(), frame.ropes.end(),
                          [](const TrueRope& rope) { return rope.closed; }));
  EXPECT_GT(share_in_sight(frame), 0.8);
  EXPECT_EQ(frame.folder.mask, lab::make_ropes(lab::RopesKind::kRings, 3, 4).image.mask);
}

TEST(DrawnFrame, ThereIsOneFrameOfAScene) {
  EXPECT_FALSE(make_frame(Split::kDrawn, Part::kTraining, 0, 0, {.frame = 1}));
}

}  // namespace
}  // namespace flowdlo::synth
