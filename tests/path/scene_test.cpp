// Paths on scenes with truth: which share of each kind has to be right is flowdlo-lab scenes
// report's. Strands that touch are for the strand field to tell apart (FieldChoice).
#include "scene/scene.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "canvas.hpp"
#include "geometry/camera.hpp"
#include "path/path.hpp"

namespace flowdlo::test {
namespace {

Curve projected(const lab::Scene& scene) {
  Curve curve;
  for (const auto& p : lab::respaced(scene.curve, scene.radius_m)) {
    curve.emplace_back(static_cast<int>(std::lround(scene.image.camera.fx * p.x() / p.z() +
                                                    scene.image.camera.cx)),
                       static_cast<int>(std::lround(scene.image.camera.fy * p.y() / p.z() +
                                                    scene.image.camera.cy)));
  }
  return curve;
}

class SceneOf : public testing::TestWithParam<lab::Kind> {};

TEST_P(SceneOf, IsFollowedFromEndToEnd) {
  for (const std::uint64_t seed : {1000, 1001, 1002, 1003}) {
    const lab::Scene scene = lab::make_scene(GetParam(), seed);

    const auto traced = path::trace(scene.frame());

    ASSERT_TRUE(traced) << seed;
    EXPECT_LT(frechet(traced->ranked.front(), projected(scene)),
              1.2F * traced->rope_width_px + 4.0F)
        << "seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, SceneOf,
                         testing::Values(lab::Kind::kSimple, lab::Kind::kHanging,
                                         lab::Kind::kOneCrossing, lab::Kind::kThin,
                                         lab::Kind::kRagged, lab::Kind::kBadDepth),
                         [](const auto& which) {
                           std::string name(lab::name_of(which.param));
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(SceneMaker, IsTheSameForTheSameSeed) {
  for (int kind = 0; kind < lab::kKinds; ++kind) {
    const auto first = lab::make_scene(static_cast<lab::Kind>(kind), 5);
    const auto second = lab::make_scene(static_cast<lab::Kind>(kind), 5);
    EXPECT_EQ(first.image.mask, second.image.mask);
    EXPECT_EQ(first.image.depth_m, second.image.depth_m);
    EXPECT_EQ(first.truth, second.truth);
  }
}

TEST(SceneMaker, KeepsStrandsApartAsRopesAre) {
  for (int kind = 0; kind < lab::kKinds; ++kind) {
    const auto scene = lab::make_scene(static_cast<lab::Kind>(kind), 11);
    EXPECT_GE(lab::separation(scene.curve, scene.radius_m), 1.94 * scene.radius_m)
        << lab::name_of(scene.kind);
  }
}

TEST(SceneMaker, TruthLiesOnTheMaskUniformInArclength) {
  const auto scene = lab::make_scene(lab::Kind::kOneCrossing, 4);
  const float first =
      std::hypot(scene.truth[1].x - scene.truth[0].x, scene.truth[1].y - scene.truth[0].y,
                 scene.truth[1].z - scene.truth[0].z);
  for (std::size_t i = 0; i < scene.truth.size(); ++i) {
    const Vector2f p = geometry::project(scene.image.camera, scene.truth[i]);
    const auto pixel =
        static_cast<std::size_t>(std::lround(p.y())) * static_cast<std::size_t>(scene.image.width) +
        static_cast<std::size_t>(std::lround(p.x()));
    EXPECT_EQ(scene.image.mask[pixel], 255) << i;
    if (i == 0) continue;
    const float step =
        std::hypot(scene.truth[i].x - scene.truth[i - 1].x, scene.truth[i].y - scene.truth[i - 1].y,
                   scene.truth[i].z - scene.truth[i - 1].z);
    EXPECT_NEAR(step, first, 0.05F * first);
  }
}

TEST(SceneMaker, NamesAndKindsMatch) {
  for (int kind = 0; kind < lab::kKinds; ++kind) {
    const auto value = static_cast<lab::Kind>(kind);
    EXPECT_EQ(lab::kind_of(lab::name_of(value)), value);
  }
  EXPECT_FALSE(lab::kind_of("no such kind"));
}

}  // namespace
}  // namespace flowdlo::test
