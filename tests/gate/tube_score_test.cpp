// Render and compare, on tubes drawn by hand. The camera looks at a plane one metre away: with
// f = 500 a millimetre is half a pixel.
#include "gate/tube_score.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "geometry/camera.hpp"

namespace flowdlo::gate {
namespace {

constexpr int kWidth = 320;
constexpr int kHeight = 240;
constexpr Intrinsics kCamera{500, 500, 160, 120};
constexpr float kRadius_m = 0.01F;  // 5 px
constexpr float kWidth_px = 10;
constexpr float kTable_m = 1.01F;

using Curve = std::function<Point3(double)>;

Centerline nodes_of(const Curve& curve) {
  Centerline nodes{};
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    nodes[i] = curve(static_cast<double>(i) / (kNodes - 1));
  }
  return nodes;
}

Point3 point(double x, double y, double z) {
  return {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
}

/// Drawn as spheres: a way of its own.
struct Picture {
  std::vector<float> depth_m =
      std::vector<float>(std::size_t{kWidth} * std::size_t{kHeight}, kTable_m);
  std::vector<std::uint8_t> mask =
      std::vector<std::uint8_t>(std::size_t{kWidth} * std::size_t{kHeight}, 0);

  explicit Picture(const Curve& curve) {
    for (int i = 0; i <= 2000; ++i) draw_sphere(curve(i / 2000.0));
  }

  void draw_sphere(const Point3& centre) {
    const Eigen::Vector2f at = geometry::project(kCamera, centre);
    const float radius_px = kRadius_m * kCamera.fx / centre.z;
    const int reach = static_cast<int>(radius_px) + 2;
    for (int v = static_cast<int>(at.y()) - reach; v <= static_cast<int>(at.y()) + reach; ++v) {
      for (int u = static_cast<int>(at.x()) - reach; u <= static_cast<int>(at.x()) + reach; ++u) {
        if (u < 0 || v < 0 || u >= kWidth || v >= kHeight) continue;
        const Eigen::Vector2f off(static_cast<float>(u) - at.x(), static_cast<float>(v) - at.y());
        const float share = off.norm() / radius_px;
        if (share > 1) continue;
        const float z = centre.z - kRadius_m * std::sqrt(1 - share * share);
        const auto i = static_cast<std::size_t>(v * kWidth + u);
        depth_m[i] = mask[i] != 0 ? std::min(depth_m[i], z) : z;
        mask[i] = 255;
      }
    }
  }

  void put_bar(int first, int last, float z) {
    for (int v = 0; v < kHeight; ++v) {
      for (int u = first; u <= last; ++u) {
        mask[static_cast<std::size_t>(v * kWidth + u)] = 0;
        depth_m[static_cast<std::size_t>(v * kWidth + u)] = z;
      }
    }
  }

  [[nodiscard]] Frame frame() const { return {kWidth, kHeight, kCamera, depth_m, mask, {}}; }
  [[nodiscard]] TubeScore score(const Centerline& nodes, float radius_m = kRadius_m) const {
    return TubeView(frame(), kWidth_px).score(nodes, radius_m);
  }
};

Point3 wave(double t) { return point(-0.2 + 0.4 * t, 0.06 * std::sin(6 * t), 1); }

/// A loop that crosses itself once; at the crossing its second visit is `lift_m` nearer.
Curve loop(double lift_m) {
  return [lift_m](double t) {
    const double s = 2.4 * (t - 0.5) * 2;
    const double x = 0.12 * (s * s * s / 3 - s) * 0.8;
    const double y = 0.08 * s * s - 0.12;
    const double swing = std::exp(-std::pow((s - 1.732) / 0.35, 2));
    return point(x, y, 1 - lift_m * swing);
  };
}

void expect_worst(const TubeScore& score) {
  EXPECT_EQ(score.mask_recall, 0);
  EXPECT_EQ(score.mask_precision, 0);
  EXPECT_EQ(score.depth_agreement, 0);
  EXPECT_EQ(score.crossing_agreement, 0);
  EXPECT_EQ(score.least_clearance, 0);
  EXPECT_EQ(score.overlap_share, 1);
  EXPECT_EQ(score.bending, 99);
}

void expect_in_range(const TubeScore& score) {
  for (const float share :
       {score.mask_recall, score.mask_precision, score.hidden_share, score.depth_agreement,
        score.crossing_agreement, score.overlap_share, score.least_sine, score.least_clearance}) {
    EXPECT_GE(share, 0);
    EXPECT_LE(share, 1);
  }
  EXPECT_LE(std::abs(score.depth_bias), 1);
  EXPECT_GE(score.crossings, 0);
  EXPECT_LE(score.crossings, 99);
  EXPECT_GE(score.bending, 0);
  EXPECT_LE(score.bending, 99);
  EXPECT_GE(score.sharpest_bend, 0);
  EXPECT_LE(score.sharpest_bend, 2);
}

TEST(TubeScore, TheRopeItselfExplainsEverything) {
  const TubeScore score = Picture(wave).score(nodes_of(wave));
  EXPECT_GT(score.mask_recall, 0.99F);
  EXPECT_GT(score.mask_precision, 0.99F);
  EXPECT_GT(score.depth_agreement, 0.99F);
  EXPECT_NEAR(score.depth_bias, 0, 0.1F);
  EXPECT_EQ(score.crossings, 0);
  EXPECT_EQ(score.overlap_share, 0);
  EXPECT_EQ(score.crossing_agreement, 1);
}

TEST(TubeScore, HalfTheRopeRecallsHalfTheMask) {
  const TubeScore score = Picture(wave).score(nodes_of([](double t) { return wave(0.5 * t); }));
  EXPECT_NEAR(score.mask_recall, 0.5F, 0.05F);
  EXPECT_GT(score.mask_precision, 0.99F);
}

TEST(TubeScore, ALoopCutShortLeavesTheLoopUnexplained) {
  const Curve whole = loop(0.024);
  // From one visit of the crossing, s = -1.732, straight on from the other.
  const Centerline cut = nodes_of([&](double t) {
    const double before = 0.5 - 1.732 / 4.8;
    return t < 0.5 ? whole(2 * t * before) : whole(1 - before + (2 * t - 1) * before);
  });
  const Picture picture(whole);
  EXPECT_GT(picture.score(nodes_of(whole)).mask_recall, 0.98F);
  EXPECT_LT(picture.score(cut).mask_recall, 0.5F);
}

TEST(TubeScore, ATubeOffTheMaskIsNotPrecise) {
  const auto aside = [](double t) {
    const Point3 p = wave(t);
    return Point3{p.x, p.y + (t > 0.5 ? 0.06F : 0.0F), p.z};
  };
  EXPECT_NEAR(Picture(wave).score(nodes_of(aside)).mask_precision, 0.5F, 0.1F);
}

TEST(TubeScore, WhatABarInFrontHidesDoesNotLowerPrecision) {
  Picture picture(wave);
  picture.put_bar(150, 180, 0.8F);
  const TubeScore score = picture.score(nodes_of(wave));
  EXPECT_GT(score.mask_precision, 0.99F);
  EXPECT_GT(score.mask_recall, 0.99F);
  EXPECT_NEAR(score.hidden_share, 31.0F / 200, 0.05F);
}

TEST(TubeScore, WhereNothingWasMeasuredBesideTheMaskTheTubeIsNotBlamed) {
  Picture picture(wave);
  picture.put_bar(150, 180, 0);  // a black bar
  EXPECT_GT(picture.score(nodes_of(wave)).mask_precision, 0.99F);
}

TEST(TubeScore, WhatLiesInFrontOfABarHasToBeSeen) {
  Picture picture(wave);
  picture.put_bar(150, 180, 1.2F);  // behind the rope, and yet no mask
  const TubeScore score = picture.score(nodes_of(wave));
  EXPECT_LT(score.mask_precision, 0.9F);
  EXPECT_EQ(score.hidden_share, 0);
}

TEST(TubeScore, TheOtherStrandOnTopDisagreesWithTheDepthsAtTheCrossing) {
  const Picture picture(loop(0.06));
  const TubeScore right = picture.score(nodes_of(loop(0.06)));
  const TubeScore wrong = picture.score(nodes_of(loop(-0.06)));
  EXPECT_EQ(right.crossings, 1);
  EXPECT_EQ(wrong.crossings, 1);
  EXPECT_GT(right.crossing_agreement, 0.95F);
  EXPECT_LT(wrong.crossing_agreement, 0.6F);
}

TEST(TubeScore, StrandsThatPassThroughEachOtherHaveNoClearance) {
  const Picture picture(loop(0.03));
  EXPECT_NEAR(picture.score(nodes_of(loop(0.03))).least_clearance, 1, 1e-6);
  EXPECT_NEAR(picture.score(nodes_of(loop(0.01))).least_clearance, 0.5F, 0.05F);
  EXPECT_NEAR(picture.score(nodes_of(loop(0))).least_clearance, 0, 0.02F);
}

TEST(TubeScore, BiasIsPositiveWhereTheMeasuredRopeLiesDeeper) {
  const auto nearer = [](double t) {
    Point3 p = wave(t);
    return Point3{p.x * 0.997F, p.y * 0.997F, p.z * 0.997F};  // the same pixels, 3 mm nearer
  };
  const TubeScore score = Picture(wave).score(nodes_of(nearer));
  EXPECT_GT(score.depth_bias, 0.3F);
  EXPECT_GT(score.depth_agreement, 0.9F);
}

TEST(TubeScore, BendsOfACircleAreItsRadiusOverItsOwn) {
  const auto circle = [](double t) {
    return point(0.1 * std::cos(5 * t), 0.1 * std::sin(5 * t), 1);
  };
  const TubeScore score = Picture(circle).score(nodes_of(circle));
  EXPECT_NEAR(score.sharpest_bend, 0.1F, 1e-3F);          // 1 cm of 10 cm
  EXPECT_NEAR(score.bending, 0.1F * 5 * 62 / 63, 1e-2F);  // r / R^2 * R * 5
}

TEST(TubeScore, IsTheWorstForWhatCannotBeDrawn) {
  const Picture picture(wave);
  for (const float bad : {std::nanf(""), std::numeric_limits<float>::infinity(), -1.0F, 0.0F}) {
    Centerline nodes = nodes_of(wave);
    nodes[20].z = bad;
    expect_worst(picture.score(nodes));
    expect_worst(picture.score(nodes_of(wave), bad));
  }
}

TEST(TubeScore, IsTheWorstWithoutAMask) {
  Picture picture(wave);
  std::fill(picture.mask.begin(), picture.mask.end(), std::uint8_t{0});
  expect_worst(picture.score(nodes_of(wave)));
}

TEST(TubeScore, OffTheImageExplainsNothing) {
  const auto away = [](double t) { return point(3 + t, 2, 1); };
  const TubeScore score = Picture(wave).score(nodes_of(away));
  EXPECT_EQ(score.mask_recall, 0);
  EXPECT_EQ(score.mask_precision, 0);
  expect_in_range(score);
}

TEST(TubeScore, StaysInRangeForAbsurdCenterlines) {
  const Picture picture(wave);
  for (const double size : {1e-30, 1e-6, 1.0, 1e3, 1e6, 1e18, 1e38}) {
    expect_in_range(picture.score(nodes_of([&](double t) {
      return point(size * std::sin(900 * t), size * std::cos(700 * t), 0.5 + 0.4 * std::sin(t));
    })));
    expect_in_range(picture.score(nodes_of([](double t) { return wave(t * 0); }),
                                  static_cast<float>(std::min(1.0, size))));
    expect_in_range(picture.score(
        nodes_of([&](double t) { return point(0, 0, std::min(9e3, 2e-6 + size * t)); })));
  }
}

TEST(TubeView, RadiusIsHalfTheWidthWhereTheNodesAre) {
  const Picture picture(wave);
  EXPECT_NEAR(TubeView(picture.frame(), kWidth_px).radius_m(nodes_of(wave)), 0.01F, 1e-5F);
}

TEST(TubeView, AsManyPixelsAsTheRopeIsWideSpanItsDiameter) {
  const Picture picture(wave);
  EXPECT_NEAR(kWidth_px * pixel_m(nodes_of(wave), kCamera), 0.02F, 2e-5F);
}

}  // namespace
}  // namespace flowdlo::gate
