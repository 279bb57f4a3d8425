#include "pictures/canvas.hpp"

#include <array>
#include <opencv2/imgproc.hpp>

#include "mat/mat_png.hpp"

namespace flowdlo::pictures {
namespace {

const cv::Scalar kInk{40, 40, 40};
const cv::Scalar kGrid{225, 225, 225};

cv::Size size_of(const std::string& text, double size) {
  int below = 0;
  return cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, size, 1, &below);
}

}  // namespace

cv::Scalar draw_color(std::size_t index) {
  static const std::array<cv::Scalar, 4> colors{cv::Scalar(60, 60, 220), cv::Scalar(200, 110, 30),
                                                cv::Scalar(170, 60, 170), cv::Scalar(30, 140, 200)};
  return colors[index % colors.size()];
}

Legend legend_of_draws(const std::string& first, const cv::Scalar& color) {
  return {{first, color},
          {"draw 1", draw_color(0)},
          {"2", draw_color(1)},
          {"3", draw_color(2)},
          {"4", draw_color(3)},
          {"estimate", kEstimateColor},
          {"TrackDLO-init", kBaselineColor}};
}

Canvas::Canvas(int width, int height) : picture_(height, width, CV_8UC3, cv::Scalar::all(255)) {}

void Canvas::write(const std::string& text, cv::Point at, double size) {
  cv::putText(picture_, text, at, cv::FONT_HERSHEY_SIMPLEX, size, kInk, 1, cv::LINE_AA);
}

void Canvas::write_left_of(const std::string& text, cv::Point at, double size) {
  write(text, {at.x - size_of(text, size).width, at.y}, size);
}

void Canvas::write_centred(const std::string& text, cv::Point at, double size) {
  write(text, {at.x - size_of(text, size).width / 2, at.y}, size);
}

void Canvas::legend(const Legend& entries, cv::Point at) {
  for (const auto& [text, color] : entries) {
    cv::rectangle(picture_, {at.x, at.y - 11, 14, 14}, color, cv::FILLED);
    write(text, {at.x + 20, at.y});
    at.x += 40 + size_of(text, 0.42).width;
  }
}

void Canvas::grid_line(cv::Point from, cv::Point to) { cv::line(picture_, from, to, kGrid); }

Result<std::vector<std::uint8_t>> Canvas::png() const { return mat::encode_png(picture_); }

}  // namespace flowdlo::pictures
