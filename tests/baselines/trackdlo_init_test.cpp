#include "baselines/trackdlo_init.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "baselines/drawn.hpp"

namespace flowdlo::baselines {
namespace {

using test::drawn;

std::vector<cv::Point> arc() {
  std::vector<cv::Point> points;
  for (int i = 0; i <= 60; ++i) {
    points.emplace_back(40 + 4 * i, 170 - cvRound(90 * std::sin(3.1415927 * i / 60)));
  }
  return points;
}

TEST(TrackdloInit, FindsAPlainArc) {
  const auto attempt = trackdlo_init(test::observation(drawn(arc(), 11)), true);
  ASSERT_EQ(attempt.status, Status::kValid) << attempt.reason;
  const double metres_a_pixel = 0.5 / 300;
  double sum = 0;
  for (std::size_t i = 1; i < kNodes; ++i) {
    sum += std::hypot(attempt.nodes[i].x - attempt.nodes[i - 1].x,
                      attempt.nodes[i].y - attempt.nodes[i - 1].y);
  }
  EXPECT_NEAR(sum / metres_a_pixel, 322, 40);
  EXPECT_NEAR(attempt.nodes[32].z, 0.5F, 1e-3F);
}

TEST(TrackdloInit, ThinRopesGiveNoOutput) {
  cv::Mat mask = test::blank();
  mask(cv::Rect(30, 100, 200, 7)).setTo(255);
  EXPECT_EQ(trackdlo_init(test::observation(mask), false).status, Status::kNoOutput);
  EXPECT_EQ(trackdlo_init(test::observation(mask), true).status, Status::kNoOutput);
}

TEST(TrackdloInit, ExactlyStraightRopesGiveNoOutput) {
  cv::Mat mask = test::blank();
  mask(cv::Rect(30, 100, 200, 11)).setTo(255);
  const auto attempt = trackdlo_init(test::observation(mask), true);
  EXPECT_EQ(attempt.status, Status::kNoOutput);
  EXPECT_EQ(attempt.reason, "no chain on the skeleton");
}

TEST(TrackdloInit, EmptyMaskGivesNoOutput) {
  EXPECT_EQ(trackdlo_init(test::observation(test::blank()), false).reason, "mask is empty");
}

TEST(TrackdloInit, WithoutDepthThereIsNoOutput) {
  const auto attempt = trackdlo_init(test::observation(drawn(arc(), 11), 0), true);
  EXPECT_EQ(attempt.reason, "fewer than 4 points with depth");
}

TEST(Checked, NodesFarFromTheMaskAreInvalid) {
  const cv::Mat mask = drawn(arc(), 11);
  Centerline nodes{};
  for (Point3& node : nodes) node = {-0.1F, 0.15F, 0.5F};  // pixel (100, 210)
  const auto attempt = checked(nodes, mask, {300, 300, 160, 120});
  EXPECT_EQ(attempt.status, Status::kInvalid);
  EXPECT_EQ(attempt.reason, "nodes lie off the mask");
}

TEST(Checked, OneNodeOutsideTheImageIsInvalid) {
  Centerline nodes{};
  for (Point3& node : nodes) node = {0, 0, 0.5F};
  nodes[5].x = 1;
  const auto attempt =
      checked(nodes, cv::Mat(240, 320, CV_8U, cv::Scalar(255)), {300, 300, 160, 120});
  EXPECT_EQ(attempt.reason, "a node projects outside the image");
}

TEST(Checked, NodesBehindTheCameraOrNotFiniteAreInvalid) {
  Centerline nodes{};
  const cv::Mat mask(240, 320, CV_8U, cv::Scalar(255));
  EXPECT_EQ(checked(nodes, mask, {300, 300, 160, 120}).status, Status::kInvalid);
  for (Point3& node : nodes) node = {0, 0, 0.5F};
  EXPECT_EQ(checked(nodes, mask, {300, 300, 160, 120}).status, Status::kValid);
  nodes[0].y = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(checked(nodes, mask, {300, 300, 160, 120}).status, Status::kInvalid);
}

}  // namespace
}  // namespace flowdlo::baselines
