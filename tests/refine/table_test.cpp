#include "refine/table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "geometry/camera.hpp"

namespace flowdlo::refine {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr int kWidth = 640;
constexpr int kHeight = 480;
constexpr float kHalf_px = 4;

/// A table that is seen at an angle, half a metre away, and an arc of a rope over it.
class Scene {
 public:
  Scene() : depth_m_(kWidth * kHeight), mask_(kWidth * kHeight, 0) {
    for (int v = 0; v < kHeight; ++v) {
      for (int u = 0; u < kWidth; ++u) depth_m_[index(u, v)] = table_m(u, v);
    }
    for (int i = 0; i < 256; ++i) {
      const float angle = 3.0F * static_cast<float>(i) / 255;
      places_.push_back({{320 + 150 * std::cos(angle), 200 + 150 * std::sin(angle)},
                         {-std::sin(angle), std::cos(angle)},
                         kHalf_px});
      for (int dv = -4; dv <= 4; ++dv) {
        for (int du = -4; du <= 4; ++du) {
          const auto u = static_cast<int>(places_.back().px.x()) + du;
          const auto v = static_cast<int>(places_.back().px.y()) + dv;
          if (du * du + dv * dv <= 16) mask_[index(u, v)] = 255;
        }
      }
    }
  }

  static std::size_t index(int u, int v) { return static_cast<std::size_t>(v * kWidth + u); }
  /// Where the ray of a pixel meets n p = 1.
  static float table_m(int u, int v) { return 1 / plane().dot(ray(u, v)); }
  static Vector3f plane() { return {0.2F, -0.6F, 2}; }
  static Vector3f ray(int u, int v) {
    return {(static_cast<float>(u) - 320) / 600, (static_cast<float>(v) - 240) / 600, 1};
  }

  [[nodiscard]] Frame frame() const {
    return {kWidth, kHeight, {600, 600, 320, 240}, depth_m_, mask_, {}};
  }

  std::optional<Table> table() {
    beside.assign(places_.size(), {});
    return table_beside(places_, frame(), beside);
  }

  std::vector<float>& depth_m() { return depth_m_; }
  [[nodiscard]] const std::vector<std::uint8_t>& mask() const { return mask_; }
  std::vector<Beside> beside;

 private:
  std::vector<float> depth_m_;
  std::vector<std::uint8_t> mask_;
  std::vector<AxisPlace> places_;
};

/// How far the plane that was found is from the true one along the rays of the image's middle.
float off_m(const Table& table) {
  float most = 0;
  for (const int u : {200, 320, 440}) {
    for (const int v : {220, 340}) {
      most = std::max(most, std::abs(1 / table.plane.dot(Scene::ray(u, v)) - Scene::table_m(u, v)));
    }
  }
  return most;
}

TEST(Table, IsThePlaneThatLiesBesideTheRope) {
  Scene scene;
  const auto table = scene.table();
  ASSERT_TRUE(table);
  EXPECT_LT(off_m(*table), 3e-4F);
  EXPECT_GT(table->known, 0.95F);
  EXPECT_LT(table->misfit, 0.01F);  // of an inverse depth of 2: the median of whole pixels
  for (const Beside& beside : scene.beside) {
    if (beside.sides > 0) {
      EXPECT_NEAR(beside.depth_m, 0.5F, 0.15F);
    }
  }
}

TEST(Table, IsFarSurerThanTheDepthsThatAreOffInStretches) {
  Scene scene;
  std::mt19937 random(1);
  std::normal_distribution<float> noise(0, 0.04F);  // of 1 / z: a centimetre at half a metre
  std::vector<float> patch(40 * 30);
  for (float& off : patch) off = noise(random);
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      float& depth_m = scene.depth_m()[Scene::index(u, v)];
      depth_m = 1 / (1 / depth_m + patch[static_cast<std::size_t>(v / 16 * 40 + u / 16)]);
    }
  }
  const auto table = scene.table();
  ASSERT_TRUE(table);
  EXPECT_LT(off_m(*table), 0.005F);
  EXPECT_NEAR(table->misfit, 0.04F, 0.015F);
  EXPECT_GT(table->roughness / table->misfit, 1);  // a patch is a window wide
}

TEST(Table, SmoothWavesAreNotRough) {
  Scene scene;
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < kWidth; ++u) {
      scene.depth_m()[Scene::index(u, v)] +=
          0.01F * std::sin(static_cast<float>(u) / 35) * std::cos(static_cast<float>(v) / 35);
    }
  }
  const auto table = scene.table();
  ASSERT_TRUE(table);
  EXPECT_LT(table->roughness, 0.85F * table->misfit);
}

TEST(Table, ThingsThatLieOnItDoNotLiftIt) {
  Scene scene;
  for (int v = 0; v < kHeight; ++v) {
    for (int u = 0; u < 260; ++u)
      scene.depth_m()[Scene::index(u, v)] -= 0.1F;  // a third of the arc
  }
  const auto table = scene.table();
  ASSERT_TRUE(table);
  EXPECT_LT(off_m(*table), 1e-3F);
}

TEST(Table, ThereIsNoneWhereNothingIsSeenBesideTheRope) {
  Scene scene;
  for (std::size_t i = 0; i < scene.depth_m().size(); ++i) {
    if (scene.mask()[i] == 0) scene.depth_m()[i] = 0;
  }
  EXPECT_FALSE(scene.table());
  for (const Beside& beside : scene.beside) EXPECT_EQ(beside.sides, 0);
}

TEST(Table, HostileDepthsAreNoTable) {
  Scene scene;
  const float hostile[] = {std::numeric_limits<float>::quiet_NaN(),
                           std::numeric_limits<float>::infinity(),
                           -std::numeric_limits<float>::infinity(),
                           -1,
                           0,
                           1e30F};
  for (std::size_t i = 0; i < scene.depth_m().size(); ++i) scene.depth_m()[i] = hostile[i % 6];
  EXPECT_FALSE(scene.table());
}

TEST(Table, NoPlacesAreNoTable) {
  const Scene scene;
  EXPECT_FALSE(table_beside({}, scene.frame(), {}));
}

TEST(Table, ARopeThatLiesOnItHasARadiusBetweenAxisAndTable) {
  Table table;
  table.plane = Scene::plane();
  const Vector3f point = 0.45F * Scene::ray(300, 300);
  const auto share = share_to(table, point, 0.004F);
  ASSERT_TRUE(share);
  const float above_m = (1 - table.plane.dot(*share * point)) / table.plane.norm();
  EXPECT_NEAR(above_m, 0.004F, 1e-6F);
  EXPECT_FALSE(share_to(table, Vector3f(0.9F, 0.5F, 0.1F), 0.004F));  // along the table
  EXPECT_FALSE(share_to(table, point, 1));  // thicker than the table is far away
}

}  // namespace
}  // namespace flowdlo::refine
