#include "evidence/ground_depth.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace flowdlo::evidence {
namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 240;
constexpr float kHalf_px = 4;
constexpr Intrinsics kCamera{300, 300, 160, 120};

/// 1 / z of a table that is seen at an angle, half a metre away.
float inverse_at(int u, int v) {
  const Eigen::Vector3f ray((static_cast<float>(u) - kCamera.cx) / kCamera.fx,
                            (static_cast<float>(v) - kCamera.cy) / kCamera.fy, 1);
  return Eigen::Vector3f(0.2F, -0.6F, 2).dot(ray);
}

/// A wave across the image; what its depth is, `rope_m` says, and what is beside it, `beside_m`.
struct Scene {
  using DepthAt = std::function<float(int u, int v)>;

  explicit Scene(const DepthAt& rope_m, const DepthAt& beside_m = table_m) {
    for (int v = 0; v < kHeight; ++v) {
      for (int u = 0; u < kWidth; ++u) {
        const float axis = 120 + 50 * std::sin(static_cast<float>(u) / 50);
        const float slope = std::cos(static_cast<float>(u) / 50);
        const bool on =
            u >= 30 && u < 290 &&
            std::abs(static_cast<float>(v) - axis) <= kHalf_px * std::hypot(1.0F, slope);
        mask.push_back(on ? 255 : 0);
        depth_m.push_back(on ? rope_m(u, v) : beside_m(u, v));
      }
    }
  }
  static float table_m(int u, int v) { return 1 / inverse_at(u, v); }
  static float none(int /*u*/, int /*v*/) { return 0; }

  [[nodiscard]] Frame frame() const { return {kWidth, kHeight, kCamera, depth_m, mask, {}}; }
  [[nodiscard]] bool on(std::size_t pixel) const { return mask[pixel] != 0; }

  std::vector<float> depth_m;
  std::vector<std::uint8_t> mask;
};

/// Metres from the camera to half a metre, of one pixel.
constexpr float kPixel_m = 0.5F / 300;

void expect_on_the_table(const Scene& scene, const std::vector<float>& depth_m) {
  ASSERT_EQ(depth_m.size(), scene.depth_m.size());
  for (std::size_t pixel = 0; pixel < depth_m.size(); ++pixel) {
    const auto u = static_cast<int>(pixel % kWidth);
    const auto v = static_cast<int>(pixel / kWidth);
    if (scene.depth_m[pixel] > 0) {
      EXPECT_EQ(depth_m[pixel], scene.depth_m[pixel]) << "what was measured stays";
    } else if (scene.on(pixel)) {
      const float over_m = Scene::table_m(u, v) - depth_m[pixel];
      EXPECT_GT(over_m, 0) << u << ", " << v;
      EXPECT_LT(over_m, 2.2F * kHalf_px * kPixel_m) << u << ", " << v << ": nearer than its back";
    }
  }
}

TEST(GroundDepth, OfARopeThatShowsNoneLiesOnTheTable) {
  const Scene scene(Scene::none);
  const auto depth_m = ground_depth(scene.frame());
  ASSERT_TRUE(depth_m);
  expect_on_the_table(scene, *depth_m);
}

TEST(GroundDepth, HoldsAThirdOfOtherThingsBesideTheRope) {
  const Scene scene(Scene::none,
                    [](int u, int v) { return u < 120 ? 0.3F : Scene::table_m(u, v); });
  const auto depth_m = ground_depth(scene.frame());
  ASSERT_TRUE(depth_m);
  expect_on_the_table(scene, *depth_m);
}

TEST(GroundDepth, FillsWhatFewPixelsDoNotTell) {
  const Scene scene([](int u, int v) { return (u * 7 + v * 13) % 211 == 0 ? 0.35F : 0; });
  const auto depth_m = ground_depth(scene.frame());
  ASSERT_TRUE(depth_m);
  expect_on_the_table(scene, *depth_m);
}

TEST(GroundDepth, IsNotAskedWhereTheRopeShowsItsOwn) {
  EXPECT_FALSE(ground_depth(Scene(Scene::table_m).frame()));
  const Scene some([](int u, int v) { return (u + 3 * v) % 40 == 0 ? 0.4F : 0; });
  EXPECT_FALSE(ground_depth(some.frame())) << "one pixel in forty";
}

TEST(GroundDepth, IsUnknownWhereNothingIsSeenBesideTheRope) {
  EXPECT_FALSE(ground_depth(Scene(Scene::none, Scene::none).frame()));
  Scene all(Scene::none);
  all.mask.assign(all.mask.size(), 255);
  all.depth_m.assign(all.depth_m.size(), 0);
  EXPECT_FALSE(ground_depth(all.frame())) << "nothing is beside a mask that is all of the image";
}

}  // namespace
}  // namespace flowdlo::evidence
