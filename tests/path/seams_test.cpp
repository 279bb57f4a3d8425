#include "path/seams.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "mat/mat_image.hpp"
#include "path/region.hpp"
#include "random/philox.hpp"
#include "scene/scene.hpp"

namespace flowdlo::test {
namespace {

constexpr int kWidth = 200;
constexpr int kHeight = 100;
constexpr float kFocal_px = 500;
constexpr float kBehind_m = 0.5F;

// Straight ropes from left to right, seen at `kFocal_px`; round in depth.
struct Ropes {
  std::vector<float> centres_px{40, 56};  // rows
  float radius_px = 8;
  int from_px = 20;  // columns
  int to_px = 180;
  float slope = 0;  // metres of depth a metre down the image
  float noise_m = 0;
  bool round = true;
};

struct Picture {
  cv::Mat mask = cv::Mat::zeros(kHeight, kWidth, CV_8U);
  std::vector<float> depth_m = std::vector<float>(kWidth * kHeight, kBehind_m);

  [[nodiscard]] Frame frame() const {
    return {kWidth,
            kHeight,
            {kFocal_px, kFocal_px, 0.5F * kWidth, 0.5F * kHeight},
            depth_m,
            {mask.ptr<std::uint8_t>(), mask.total()},
            {}};
  }
  [[nodiscard]] cv::Mat seams() const {
    const float width_px = 16;
    return mat::mat_of(
        path::find_seams(mat::image_of<std::uint8_t>(mask), {{0, 0}, width_px, width_px}, frame()));
  }
};

Picture draw(const Ropes& ropes) {
  Picture picture;
  const float m_per_px = kBehind_m / kFocal_px;
  for (int v = 0; v < kHeight; ++v) {
    for (int u = ropes.from_px; u < ropes.to_px; ++u) {
      for (const float centre : ropes.centres_px) {
        const float off = static_cast<float>(v) - centre;
        if (std::abs(off) > ropes.radius_px) continue;
        const float height = ropes.round ? std::sqrt(ropes.radius_px * ropes.radius_px - off * off)
                                         : ropes.radius_px;
        float& z = picture.depth_m[static_cast<std::size_t>(v * kWidth + u)];
        z = kBehind_m + m_per_px * (ropes.slope * static_cast<float>(v) - height);
        picture.mask.at<std::uint8_t>(v, u) = 1;
      }
    }
  }
  for (std::size_t i = 0; i < picture.depth_m.size(); ++i) {
    picture.depth_m[i] += ropes.noise_m * random::gaussian(7, i)[0];
  }
  return picture;
}

// In how many of the rope's 160 columns a seam lies within two pixels of row `v`.
int columns_cut(const cv::Mat& seams, int v) {
  if (seams.empty()) return 0;
  cv::Mat any;
  cv::reduce(seams.rowRange(v - 2, v + 3), any, 0, cv::REDUCE_MAX);
  return cv::countNonZero(any);
}

int components(const cv::Mat& mask, const cv::Mat& seams) {
  cv::Mat rest = mask.clone();
  if (!seams.empty()) rest.setTo(0, seams);
  cv::Mat labels;
  return cv::connectedComponents(rest, labels, 8) - 1;
}

TEST(Seams, RunAllAlongTheValleyBetweenTwoRopes) {
  const Picture picture = draw({});
  const cv::Mat seams = picture.seams();
  EXPECT_GT(columns_cut(seams, 48), 150);
  EXPECT_EQ(components(picture.mask, seams), 2);
}

TEST(Seams, LieBetweenAnyTwoOfThreeRopes) {
  Ropes ropes;
  ropes.centres_px = {30, 46, 62};
  const Picture picture = draw(ropes);
  const cv::Mat seams = picture.seams();
  EXPECT_GT(columns_cut(seams, 38), 150);
  EXPECT_GT(columns_cut(seams, 54), 150);
  EXPECT_EQ(components(picture.mask, seams), 3);
}

TEST(Seams, AreFoundOnATiltedPlane) {
  Ropes ropes;
  ropes.slope = 0.6F;
  EXPECT_GT(columns_cut(draw(ropes).seams(), 48), 150);
}

TEST(Seams, AreFoundInNoise) {
  Ropes ropes;
  ropes.noise_m = 0.15F * ropes.radius_px * kBehind_m / kFocal_px;
  const Picture picture = draw(ropes);
  EXPECT_EQ(components(picture.mask, picture.seams()), 2);
}

TEST(Seams, AreFoundInDepthsThatComeInCoarseSteps) {
  Ropes ropes;
  ropes.noise_m = 0.15F * ropes.radius_px * kBehind_m / kFocal_px;
  Picture picture = draw(ropes);
  for (float& z : picture.depth_m) z = 0.003F * std::round(z / 0.003F);
  EXPECT_EQ(components(picture.mask, picture.seams()), 2);
}

TEST(Seams, AreFoundWhereNothingShowsHowWideOneRopeIs) {
  Ropes ropes;
  ropes.centres_px = {30, 46, 62};
  Picture picture = draw(ropes);
  picture.mask *= 255;
  const auto region = path::clean(picture.frame());
  ASSERT_TRUE(region);
  EXPECT_EQ(components(mat::mat_over(region->mask), {}), 3);
  EXPECT_NEAR(region->width_px, 16, 3);
}

TEST(Seams, JoinTheMasksOwnSlits) {
  Picture picture = draw({});
  for (int u = 30; u < 170; u += 12) picture.mask(cv::Rect(u, 48, 8, 1)) = 0;
  EXPECT_EQ(components(picture.mask, picture.seams()), 2);
}

TEST(Seams, LeaveNoSliverBesideASlit) {
  Picture picture = draw({});
  picture.mask(cv::Rect(50, 50, 100, 2)) = 0;  // off the valley
  EXPECT_EQ(components(picture.mask, picture.seams()), 2);
}

TEST(Seams, AreNotFoundInOneRopeTwiceAsWide) {
  Ropes ropes;
  ropes.centres_px = {48};
  ropes.radius_px = 16;
  EXPECT_TRUE(draw(ropes).seams().empty());
}

TEST(Seams, AreNotFoundInNoiseAlone) {
  Ropes ropes;
  ropes.round = false;
  ropes.noise_m = 0.005F;
  EXPECT_TRUE(draw(ropes).seams().empty());
}

TEST(Seams, AreNotFoundWhereTheRopesTouchForAShortWayOnly) {
  Ropes ropes;
  ropes.to_px = ropes.from_px + 60;
  EXPECT_TRUE(draw(ropes).seams().empty());
}

TEST(Seams, NeedDepths) {
  for (const float nothing :
       {0.0F, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    Picture picture = draw({});
    std::fill(picture.depth_m.begin(), picture.depth_m.end(), nothing);
    EXPECT_TRUE(picture.seams().empty());
  }
}

TEST(Seams, AreNotFoundAtCrossings) {
  for (const auto kind : {lab::Kind::kOneCrossing, lab::Kind::kHangingLoops, lab::Kind::kRagged}) {
    for (std::uint64_t seed = 5050; seed < 5060; ++seed) {
      const lab::Scene scene = lab::make_scene(kind, seed);
      const auto region = path::clean(scene.frame());
      ASSERT_TRUE(region);
      EXPECT_TRUE(region->seams.empty()) << seed;
    }
  }
}

TEST(Seams, OutliveTheFilterOfARaggedMask) {
  const lab::Scene scene = lab::make_scene(lab::Kind::kCoil, 5014);
  const auto region = path::clean(scene.frame());
  ASSERT_TRUE(region);
  const path::Region filtered = path::smoothed(*region, 7);
  const cv::Mat seams = mat::mat_over(filtered.seams);
  EXPECT_EQ(cv::countNonZero(mat::mat_over(filtered.mask) & seams), 0);
  EXPECT_GT(cv::countNonZero(seams), 500);
}

}  // namespace
}  // namespace flowdlo::test
