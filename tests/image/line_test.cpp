// Lines have the pixels of OpenCV's, and are cut where it cuts them.
#include "image/line.hpp"

#include <vector>

#include "pictures.hpp"

namespace flowdlo::image {
namespace {

TEST(Polyline, HasThePixelsOfOpenCvsLinesWithinTheImageAndBeyond) {
  cv::RNG random(5);
  for (int i = 0; i < 4000; ++i) {
    const int width = random.uniform(1, 120);
    const int height = random.uniform(1, 120);
    const int beyond = i % 3;
    const auto place = [&] {
      return cv::Point(random.uniform(-beyond * width, (1 + beyond) * width),
                       random.uniform(-beyond * height, (1 + beyond) * height));
    };
    const cv::Point from = place();
    const cv::Point to = place();
    cv::Mat expected = cv::Mat::zeros(height, width, CV_8U);
    cv::line(expected, from, to, cv::Scalar(7), 1, cv::LINE_8);
    Mask own({width, height}, 0);
    draw_polyline(own, std::vector<Point>{mat::point_of(from), mat::point_of(to)}, 7);
    ASSERT_TRUE(same_bits(mat::mat_over(own), expected)) << from << " to " << to;
  }
}

TEST(Polyline, GoesThroughAllItsPoints) {
  const std::vector<cv::Point> points{{3, 4}, {60, 20}, {61, 20}, {10, 50}, {10, 4}};
  std::vector<Point> own_points;
  for (const cv::Point& p : points) own_points.push_back(mat::point_of(p));
  cv::Mat expected(64, 80, CV_8U, cv::Scalar(255));
  cv::polylines(expected, points, false, cv::Scalar(0));
  Mask own({80, 64}, 255);
  draw_polyline(own, own_points, 0);
  EXPECT_TRUE(same_bits(mat::mat_over(own), expected));
}

}  // namespace
}  // namespace flowdlo::image
