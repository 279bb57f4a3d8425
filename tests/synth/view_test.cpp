#include "synth/view.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "synth/still_life.hpp"

namespace flowdlo::synth {
namespace {

std::optional<Rope> some_rope(Dice& dice) {
  for (int k = 0; k < 100; ++k) {
    if (auto rope = try_thesis_rope("S", dice)) return rope;
  }
  return std::nullopt;
}

TEST(View, TheRopeRestsOnTheTableOfItsCamera) {
  Dice dice({Split::kThesis, Part::kTraining, 3, 3}, Use::kRope);
  const auto rope = some_rope(dice);
  ASSERT_TRUE(rope);
  std::optional<View> view;
  for (int k = 0; k < 100 && !view; ++k) view = try_thesis_view({&*rope, 1}, dice);
  ASSERT_TRUE(view);

  for (const Vector3d& p : view->curves.front().points) {
    const double height = view->ground.normal.dot(p) - view->ground.offset_m;
    ASSERT_NEAR(height, rope->radius_m, 1e-9);
    const Vector2d at = view->project(p);
    ASSERT_GE(at.x(), 0);
    ASSERT_LE(at.x(), view->sensor->width - 1);
    ASSERT_GE(at.y(), 0);
    ASSERT_LE(at.y(), view->sensor->height - 1);
  }
  EXPECT_LT(view->ground.normal.z(), 0) << "the table's upper side faces the camera";
}

TEST(Tracer, SquareEndsStopAtTheCurveAndRoundOnesARadiusBeyond) {
  test::StillLife scene;
  arrange(scene, 0.5, DepthPrinciple::kStereo);
  const auto row = [](const Picture& picture) {
    return static_cast<int>(
        std::count(picture.mask.begin() + 119 * 320, picture.mask.begin() + 120 * 320, 255));
  };
  EXPECT_NEAR(row(scene.picture), 212, 1);  // 200 px of axis, 6 px at both ends
  scene.rope.square_ends = true;
  const auto tracer = Tracer::create(scene.view, scene.ropes(), {});
  ASSERT_TRUE(tracer);
  EXPECT_NEAR(row(tracer->take_picture()), 204, 1);  // their upper edge is nearer than the axis
}

TEST(Tracer, AThingInFrontTakesTheRopesMask) {
  test::StillLife scene;
  arrange(scene, 0.5, DepthPrinciple::kStereo);
  Thing bar;
  bar.kind = ThingKind::kBar;
  bar.capsules.push_back({{0, -0.3, 0.4}, {0, 0.3, 0.4}, 0.01});
  const std::vector<Thing> things = {bar};
  const auto tracer = Tracer::create(scene.view, scene.ropes(), things);
  ASSERT_TRUE(tracer);
  const Picture picture = tracer->take_picture();

  EXPECT_EQ(picture.mask[119 * 320 + 160], 0);
  EXPECT_NEAR(picture.depth_m[119 * 320 + 160], 0.39, 1e-3);
  EXPECT_EQ(picture.mask[119 * 320 + 80], 255);
}

TEST(Tracer, AlongRunsFromOneEndToTheOther) {
  test::StillLife scene;
  arrange(scene, 0.5, DepthPrinciple::kStereo);
  for (const Surface& seen : scene.picture.surfaces) {
    const auto u = static_cast<double>(seen.pixel % 320);
    const double expected =
        (u - 159.5 + 100) / 200 * static_cast<double>(scene.view.curves.front().points.size() - 1);
    ASSERT_NEAR(seen.along, std::clamp(expected, 0.0, 1e9), 2.5) << u;
  }
}

}  // namespace
}  // namespace flowdlo::synth
