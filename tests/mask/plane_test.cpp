// A mask by what stands out of the table.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "flowdlo/frame_folder.hpp"
#include "flowdlo/mask.hpp"
#include "mask/table_scene.hpp"
#include "support/source_dir.hpp"

namespace flowdlo {
namespace {

using ::testing::HasSubstr;
using testing::overlap;
using testing::TableScene;

void expect_the_table(const Plane& plane) {
  const float distance_m = TableScene::distance_m();
  EXPECT_NEAR(plane.normal.x, -0.1F * distance_m, 2e-3);
  EXPECT_NEAR(plane.normal.y, -0.5F * distance_m, 2e-3);
  EXPECT_NEAR(plane.normal.z, -1.4F * distance_m, 2e-3);
  EXPECT_NEAR(plane.distance_m, distance_m, 1e-3);
}

TEST(FitPlane, IsTheTableAndSaysHowNoisyItIs) {
  for (const float noise_m : {0.0F, 0.0005F, 0.0015F}) {
    const TableScene scene(noise_m);
    const auto plane = fit_plane(scene.frame());
    ASSERT_TRUE(plane) << plane.error().message;
    expect_the_table(*plane);
    EXPECT_NEAR(plane->noise_m, noise_m, 0.25F * noise_m + 1e-5F);
    EXPECT_GT(plane->share, 0.85F);
  }
}

TEST(FitPlane, IsTheLargestPlaneWhereHalfOfTheImageIsSomethingElse) {
  TableScene scene;
  for (int v = 0; v < TableScene::kHeight; ++v) {
    for (int u = 0; u < 150; ++u) {  // a heap of things
      scene.depth_m[TableScene::at(u, v)] = 0.3F + 0.1F * std::sin(static_cast<float>(u * v) / 900);
    }
  }
  const auto plane = fit_plane(scene.frame());
  ASSERT_TRUE(plane) << plane.error().message;
  expect_the_table(*plane);
}

TEST(FitPlane, FailsWhereThereIsNone) {
  TableScene scene;
  for (std::size_t pixel = 0; pixel < scene.depth_m.size(); ++pixel) {
    scene.depth_m[pixel] =
        0.4F + 0.5F * static_cast<float>(random::philox(3, pixel)[0] % 1000) / 1000;
  }
  const auto plane = fit_plane(scene.frame());
  ASSERT_FALSE(plane);
  EXPECT_EQ(plane.error().code, ErrorCode::kBadInput);
  EXPECT_THAT(plane.error().message, HasSubstr("expected a table"));
}

TEST(FitPlane, FailsWithoutDepth) {
  TableScene scene;
  for (const float none : {0.0F, -1.0F, std::numeric_limits<float>::quiet_NaN(),
                           std::numeric_limits<float>::infinity()}) {
    scene.depth_m.assign(scene.depth_m.size(), none);
    EXPECT_FALSE(fit_plane(scene.frame())) << none;
  }
}

TEST(MaskFromPlane, IsTheRopeWhateverItsColour) {
  TableScene scene;
  scene.color_bgr.clear();
  const auto mask = mask_from_plane(scene.frame(), {});
  ASSERT_TRUE(mask) << mask.error().message;
  EXPECT_GT(overlap(*mask, scene.rope), 0.97);
}

TEST(MaskFromPlane, LeavesAHigherThingOut) {
  TableScene scene;
  for (int v = 190; v < 230; ++v) {
    for (int u = 200; u < 260; ++u) scene.depth_m[TableScene::at(u, v)] -= 0.15F;
  }
  const auto mask = mask_from_plane(scene.frame(), {});
  ASSERT_TRUE(mask);
  EXPECT_GT(overlap(*mask, scene.rope), 0.97);
}

TEST(MaskFromPlane, FindsNothingThatIsNoHigherThanTheNoise) {
  const TableScene scene(0.004F);  // 6 mm are less than three deviations
  const auto mask = mask_from_plane(scene.frame(), {});
  ASSERT_TRUE(mask);
  EXPECT_LT(testing::pixels_of(*mask), 400U);
}

TEST(MaskFromPlane, TakesDepthInMillimetresWithHoles) {
  TableScene scene;
  for (std::size_t pixel = 0; pixel < scene.depth_m.size(); ++pixel) {
    scene.depth_m[pixel] = std::round(1000 * scene.depth_m[pixel]) / 1000;
    if (random::philox(11, pixel)[0] % 10 == 0) scene.depth_m[pixel] = 0;
  }
  const auto mask = mask_from_plane(scene.frame(), {});
  ASSERT_TRUE(mask);
  EXPECT_GT(overlap(*mask, scene.rope), 0.93);
}

TEST(MaskFromPlane, GivesTheSameBitsTwice) {
  const TableScene scene;
  EXPECT_EQ(*mask_from_plane(scene.frame(), {}), *mask_from_plane(scene.frame(), {}));
}

TEST(MaskFromPlane, OfTheExampleIsTheMaskThatShips) {
  const auto folder = load_frame_folder(test::source_dir() / "examples/frames/overhand_loop");
  ASSERT_TRUE(folder);
  const auto mask = mask_from_plane(folder->frame(), {});
  ASSERT_TRUE(mask) << mask.error().message;
  EXPECT_GT(overlap(*mask, folder->mask), 0.8);
}

TEST(MaskFromPlane, NamesEveryFault) {
  const TableScene scene;
  Frame frame = scene.frame();
  frame.depth_m = frame.depth_m.first(5);
  frame.intrinsics.fx = 0;
  const auto mask = mask_from_plane(frame, {.least_m = 0, .most_m = -1});
  ASSERT_FALSE(mask);
  for (const char* what : {"depth_m: expected 76800 values", "intrinsics", "least_m", "most_m"}) {
    EXPECT_THAT(mask.error().message, HasSubstr(what));
  }
}

}  // namespace
}  // namespace flowdlo
