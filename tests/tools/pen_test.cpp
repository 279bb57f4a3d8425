#include "pen.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "image/masks.hpp"
#include "mat/mat_image.hpp"
#include "picture.hpp"

namespace flowdlo::tools {
namespace {

using support::Color;
using support::Picture;

constexpr std::uint8_t kFull = 255;

image::Mask paper(int width = 120, int height = 90) { return {{width, height}, 0}; }

/// Pixels that are covered, in parts and whole.
double covered(const image::Mask& mask) {
  double sum = 0;
  for (std::size_t i = 0; i < mask.total(); ++i) sum += mask.data()[i];
  return sum / kFull;
}

/// What a stroke covers of each pixel, by OpenCV's line of whole pixels on a picture `kFiner` times
/// as large.
constexpr int kFiner = 16;
cv::Mat covered_by_opencv(const std::vector<Spot>& points, int width_px, const cv::Size& size) {
  cv::Mat large(size * kFiner, CV_8UC1, cv::Scalar(0));
  std::vector<cv::Point> corners;
  for (const Spot& point : points) {
    corners.emplace_back(cvRound(kFiner * (point.x + 0.5F) - 0.5F),
                         cvRound(kFiner * (point.y + 0.5F) - 0.5F));
  }
  cv::polylines(large, corners, false, cv::Scalar(255), width_px * kFiner);
  cv::Mat small;
  cv::resize(large, small, size, 0, 0, cv::INTER_AREA);
  return small;
}

TEST(Pen, StrokeCoversItsLengthTimesItsWidthAndAHalfDiscAtEachEnd) {
  for (const float width : {1.0F, 3.0F, 5.5F}) {
    auto mask = paper();
    const std::array points{Spot{20.3F, 15.6F}, Spot{100.1F, 70.2F}};
    Pen(mask).stroke(points, width, kFull);
    const double length = std::hypot(100.1 - 20.3, 70.2 - 15.6);
    const double area = length * width + std::numbers::pi * width * width / 4;
    EXPECT_NEAR(covered(mask), area, 0.02 * area) << width;
  }
}

TEST(Pen, StrokeCoversOfEachPixelWhatOpenCVsFineLineDoes) {
  const std::vector<Spot> points{{12.5F, 70.2F}, {30, 20.75F}, {61.4F, 60}, {95, 12.1F}, {110, 80}};
  for (const int width_px : {1, 5, 9}) {
    auto mask = paper();
    Pen(mask).stroke(points, static_cast<float>(width_px), kFull);
    const auto theirs = covered_by_opencv(points, width_px, {120, 90});
    EXPECT_LE(cv::norm(mat::mat_over(mask), theirs, cv::NORM_INF), 50) << width_px;
    EXPECT_LE(cv::norm(mat::mat_over(mask), theirs, cv::NORM_L1),
              (0.04 + 0.04 / width_px) * cv::sum(theirs)[0])
        << width_px;
  }
}

TEST(Pen, DiscHasItsAreaAndItsCentre) {
  for (const float radius : {1.2F, 8.5F, 30.0F}) {
    auto mask = paper();
    Pen(mask).disc({60, 45}, radius, kFull);
    const double area = std::numbers::pi * radius * radius;
    EXPECT_NEAR(covered(mask), area, 0.02 * area) << radius;
    const auto moments = cv::moments(mat::mat_over(mask));
    EXPECT_NEAR(moments.m10 / moments.m00, 60, 0.02);
    EXPECT_NEAR(moments.m01 / moments.m00, 45, 0.02);
  }
}

TEST(Pen, RingIsEmptyWithin) {
  auto mask = paper();
  Pen(mask).ring({60, 45}, 20, 2, kFull);
  const double area = 2 * std::numbers::pi * 20 * 2;
  EXPECT_NEAR(covered(mask), area, 0.02 * area);
  EXPECT_EQ(mask.at(45, 60), 0);
  EXPECT_EQ(mask.at(45, 80), kFull);
}

TEST(Pen, PixelThatIsHalfCoveredTakesHalfOfTheInk) {
  Picture picture({9, 6}, Color{100, 0, 200});
  const std::array points{Spot{-5, 2.5F}, Spot{15, 2.5F}};  // between rows 2 and 3
  Pen(picture).stroke(points, 1, Color{200, 100, 0});
  for (const int v : {2, 3}) {
    EXPECT_NEAR(picture.at(v, 4)[0], 150, 2);
    EXPECT_NEAR(picture.at(v, 4)[1], 50, 2);
    EXPECT_NEAR(picture.at(v, 4)[2], 100, 2);
  }
  EXPECT_EQ(picture.at(1, 4), (Color{100, 0, 200}));
  EXPECT_EQ(picture.at(4, 4), (Color{100, 0, 200}));
}

TEST(Pen, PointsInOnePlaceAreADisc) {
  auto dot = paper();
  auto disc = paper();
  const std::array points{Spot{40, 40}, Spot{40, 40}, Spot{40, 40}};
  Pen(dot).stroke(points, 6, kFull);
  Pen(disc).disc({40, 40}, 3, kFull);
  EXPECT_TRUE(image::same(dot, disc));
  Pen(dot).stroke({}, 6, kFull);
}

TEST(Pen, WhatLiesBeyondTheImageIsNotDrawn) {
  auto whole = paper(200, 200);
  auto part = whole.clone().part({0, 0, 200, 200});
  image::Mask inner = part.part({50, 60, 70, 80});
  const std::array points{Spot{-1e5F, -1e5F}, Spot{100, 90}, Spot{1e5F, -3e4F}};
  std::vector<Spot> moved;
  for (const Spot& point : points) moved.push_back(point - Spot{50, 60});
  Pen(inner).stroke(moved, 7, kFull);
  Pen(inner).disc({-3, -3}, 20, kFull);
  for (int v = 0; v < 200; ++v) {
    for (int u = 0; u < 200; ++u) {
      if (image::Rect{50, 60, 70, 80}.contains({u, v})) continue;
      EXPECT_EQ(part.at(v, u), 0) << u << ' ' << v;
    }
  }
  EXPECT_GT(covered(inner), 400);
}

TEST(Pen, WordsStandOnTheirLineAndAreAsWideAsIsSaid) {
  const Lettering lettering{20, 2};
  for (const std::string words : {"A", "supported 61", "0.98 (draw 4 of 4)"}) {
    auto mask = paper(600, 90);
    Pen(mask).write(words, {30, 60}, lettering, kFull);
    const auto box = cv::boundingRect(mat::mat_over(mask));
    EXPECT_GE(box.x, 28) << words;
    EXPECT_LE(box.x + box.width, 30 + lettering.width_px(words) + 2) << words;
    EXPECT_GT(box.width, 0.8F * lettering.width_px(words) - 8) << words;
    EXPECT_NEAR(box.y, 38, 4) << words << ": brackets are higher than letters";
  }
  auto mask = paper();
  Pen(mask).write("H", {30, 60}, lettering, kFull);
  const auto box = cv::boundingRect(mat::mat_over(mask));
  EXPECT_NEAR(box.height, 22, 1.1) << "a capital letter and its line's width";
  EXPECT_NEAR(box.y + box.height, 62, 1.1) << "the line below";
}

TEST(Pen, BytesThatAreNoLettersAreQuestionMarks) {
  auto strange = paper();
  auto marks = paper();
  Pen(strange).write("a\xC3\xA9\n\x7F", {5, 50}, {18, 2}, kFull);
  Pen(marks).write("a????", {5, 50}, {18, 2}, kFull);
  EXPECT_TRUE(image::same(strange, marks));
  EXPECT_GT(covered(marks), 50);
  Pen(marks).write("", {5, 50}, {18, 2}, kFull);
}

}  // namespace
}  // namespace flowdlo::tools
