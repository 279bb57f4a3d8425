#include "strand/depth_faults.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "field/sight.hpp"
#include "strand/noise.hpp"

namespace flowdlo::strand {
namespace {

/// The mean of what is known within `reach_px`, where anything is; elsewhere 0.
cv::Mat smooth_where_known(const cv::Mat& depth, double reach_px) {
  cv::Mat known;
  cv::threshold(depth, known, 0, 1, cv::THRESH_BINARY);
  cv::Mat weight;
  cv::Mat sum;
  cv::GaussianBlur(known, weight, {0, 0}, reach_px);
  cv::GaussianBlur(depth, sum, {0, 0}, reach_px);
  return sum / cv::max(weight, 1e-3);
}

}  // namespace

void spoil_depth(float focal_px, Dice& dice, cv::Mat& depth) {
  const cv::Mat none = depth <= 0;
  const cv::Scalar mean = cv::mean(depth, depth > 0);
  const auto width_m = static_cast<float>(field::kRope_px * mean[0]) / focal_px;
  if (dice.chance(0.3)) {  // windows of a matcher: thin things sink into what is behind
    const cv::Mat smooth = smooth_where_known(depth, static_cast<double>(dice.uniform(0.6F, 3)));
    const double share = static_cast<double>(dice.uniform(0.3F, 1));
    depth = (1 - share) * depth + share * smooth;
  }
  if (dice.chance(0.4)) {
    const float deviation = dice.uniform(0, 0.3F) * width_m;
    if (dice.chance(0.5)) {
      cv::Mat noise = smooth_noise(depth.cols, static_cast<double>(dice.uniform(2, 6)), dice);
      depth += static_cast<double>(2 * deviation) * noise;
    } else {
      add_noise(depth, deviation, dice);
    }
  }
  depth += static_cast<double>(dice.uniform(-0.2F, 0.2F) * width_m);
  if (dice.chance(0.3)) {  // steps of the sensor
    const float step = dice.uniform(0.02F, 0.5F) * std::max(width_m, 1e-4F);
    for (int i = 0; i < depth.rows * depth.cols; ++i) {
      float& z = depth.ptr<float>()[i];
      z = std::round(z / step) * step;
    }
  }
  depth.setTo(0, none);
  for (int k = dice.chance(0.4) ? dice.integer(1, 2) : 0; k > 0; --k) {
    cv::ellipse(depth, {dice.integer(0, depth.cols), dice.integer(0, depth.rows)},
                {dice.integer(2, 30), dice.integer(2, 16)},
                static_cast<double>(dice.uniform(0, 180)), 0, 360, cv::Scalar(0), -1);
  }
  if (dice.chance(0.1)) {
    const auto share = static_cast<double>(dice.uniform(0.1F, 0.7F));
    for (int i = 0; i < depth.rows * depth.cols; ++i) {
      if (dice.chance(share)) depth.ptr<float>()[i] = 0;
    }
  }
  depth = cv::max(depth, 0);
}

void keep_depth_of_mask(const cv::Mat& mask, Dice& dice, cv::Mat& depth) {
  depth.setTo(0, mask < 0.5);
  if (dice.chance(0.5)) return;
  const cv::Mat none = depth <= 0;
  const double reach_px = static_cast<double>(dice.uniform(0.5F, 1.5F)) * field::kRope_px;
  depth = smooth_where_known(depth, reach_px);
  depth.setTo(0, none);
}

}  // namespace flowdlo::strand
