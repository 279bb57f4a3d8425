#include "baselines/strokes.hpp"

#include <algorithm>
#include <cstddef>

namespace flowdlo::baselines {
namespace {

// Edge neighbours before corner neighbours, so that a walk takes staircases pixel by pixel.
constexpr int kAround[8][2] = {{0, -1}, {1, 0}, {0, 1},  {-1, 0},
                               {1, -1}, {1, 1}, {-1, 1}, {-1, -1}};

bool set_at(const cv::Mat& image, int v, int u) {
  return v >= 0 && u >= 0 && v < image.rows && u < image.cols && image.at<std::uint8_t>(v, u) != 0;
}

int neighbours(const cv::Mat& image, int v, int u) {
  int count = 0;
  for (const auto& step : kAround) count += set_at(image, v + step[1], u + step[0]) ? 1 : 0;
  return count;
}

// Follows the run from (v, u), erasing it.
Stroke walk(cv::Mat& image, int v, int u) {
  Stroke stroke;
  bool found = true;
  while (found) {
    stroke.emplace_back(static_cast<float>(u), static_cast<float>(v));
    image.at<std::uint8_t>(v, u) = 0;
    found = false;
    for (const auto& step : kAround) {
      if (!set_at(image, v + step[1], u + step[0])) continue;
      v += step[1];
      u += step[0];
      found = true;
      break;
    }
  }
  return stroke;
}

}  // namespace

cv::Mat junction_pixels(const cv::Mat& skeleton) {
  cv::Mat junctions = cv::Mat::zeros(skeleton.size(), CV_8U);
  for (int v = 0; v < skeleton.rows; ++v) {
    for (int u = 0; u < skeleton.cols; ++u) {
      if (set_at(skeleton, v, u) && neighbours(skeleton, v, u) > 2) {
        junctions.at<std::uint8_t>(v, u) = 255;
      }
    }
  }
  return junctions;
}

std::vector<Stroke> strokes_of(const cv::Mat& skeleton, const cv::Mat& junctions) {
  cv::Mat left = skeleton.clone();
  left.setTo(0, junctions != 0);
  std::vector<Stroke> strokes;
  for (const bool rings : {false, true}) {  // whatever has an end first, then what has none
    for (int v = 0; v < left.rows; ++v) {
      for (int u = 0; u < left.cols; ++u) {
        if (set_at(left, v, u) && (rings || neighbours(left, v, u) <= 1)) {
          strokes.push_back(walk(left, v, u));
        }
      }
    }
  }
  return strokes;
}

double length_px(const Stroke& stroke) {
  double sum = 0;
  for (std::size_t i = 1; i < stroke.size(); ++i) sum += cv::norm(stroke[i] - stroke[i - 1]);
  return sum;
}

cv::Point2f direction_out(const Stroke& stroke, bool end, double skip_px, double span_px) {
  Stroke inwards = stroke;
  if (end) std::reverse(inwards.begin(), inwards.end());
  const double whole = length_px(inwards);
  skip_px = std::min(skip_px, whole / 2);
  double along = 0;
  std::size_t near = 0;
  std::size_t far = inwards.size() - 1;
  for (std::size_t i = 1; i < inwards.size(); ++i) {
    along += cv::norm(inwards[i] - inwards[i - 1]);
    if (along <= skip_px) near = i;
    if (along >= skip_px + span_px) {
      far = i;
      break;
    }
  }
  if (far <= near) near = 0;
  const cv::Point2f chord = inwards[near] - inwards[far];
  const auto size = static_cast<float>(cv::norm(chord));
  return size > 0 ? cv::Point2f(chord.x / size, chord.y / size) : cv::Point2f(0, 0);
}

}  // namespace flowdlo::baselines
