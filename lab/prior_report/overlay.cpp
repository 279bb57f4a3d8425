#include "prior_report/overlay.hpp"

#include <algorithm>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace flowdlo::lab {
namespace {

constexpr int kPlotWidth = 640;
const cv::Scalar kTruth{60, 230, 60};
const cv::Scalar kEstimate{40, 40, 255};
const cv::Scalar kUnsupported{40, 230, 255};

cv::Mat plot_depths(const Centerline& truth, const prior::Prior& prior, int height) {
  cv::Mat plot(height, kPlotWidth, CV_8UC3, cv::Scalar(25, 25, 25));
  float low = truth[0].z;
  float high = low;
  for (const Point3& p : truth) {
    low = std::min(low, p.z);
    high = std::max(high, p.z);
  }
  const float margin = 0.2F * (high - low) + 0.005F;
  const auto at = [&](std::size_t i, float z) {
    const float y = (z - low + margin) / (high - low + 2 * margin) * static_cast<float>(height);
    return cv::Point(static_cast<int>(i) * kPlotWidth / kNodes + 5, static_cast<int>(y));
  };
  for (std::size_t i = 0; i < kNodes; ++i) {
    cv::circle(plot, at(i, truth[i].z), 3, kTruth, cv::FILLED);
    cv::circle(plot, at(i, prior.nodes[i].z), 3, prior.support[i] != 0 ? kEstimate : kUnsupported,
               cv::FILLED);
  }
  return plot;
}

}  // namespace

bool save_overlay(const std::string& file, const Scene& scene, const Centerline& truth,
                  const prior::Prior& prior) {
  const Image& image = scene.image;
  const cv::Mat color(image.height, image.width, CV_8UC3,
                      const_cast<std::uint8_t*>(image.color_bgr.data()));  // NOLINT
  const cv::Mat mask(image.height, image.width, CV_8U,
                     const_cast<std::uint8_t*>(image.mask.data()));  // NOLINT
  cv::Rect box = cv::boundingRect(mask);
  box = cv::Rect(box.x - 10, box.y - 10, box.width + 20, box.height + 20) &
        cv::Rect(0, 0, image.width, image.height);
  const int zoom = std::max(1, 1400 / std::max(box.width, box.height));
  cv::Mat picture;
  cv::resize(color(box) * 0.6, picture, {}, zoom, zoom, cv::INTER_NEAREST);
  cv::Mat dim;
  cv::resize(mask(box), dim, picture.size(), 0, 0, cv::INTER_NEAREST);
  picture.setTo(cv::Scalar(20, 20, 20), dim == 0);
  const auto at = [&](const Point3& p) {
    const float u = image.camera.fx * p.x / p.z + image.camera.cx - static_cast<float>(box.x);
    const float v = image.camera.fy * p.y / p.z + image.camera.cy - static_cast<float>(box.y);
    return cv::Point(static_cast<int>((u + 0.5F) * static_cast<float>(zoom)),
                     static_cast<int>((v + 0.5F) * static_cast<float>(zoom)));
  };
  for (std::size_t i = 0; i < kNodes; ++i) {
    cv::line(picture, at(truth[i]), at(prior.nodes[i]), {255, 255, 255}, 1);
    if (i + 1 < kNodes) {
      cv::line(picture, at(truth[i]), at(truth[i + 1]), kTruth, 1);
      cv::line(picture, at(prior.nodes[i]), at(prior.nodes[i + 1]), kEstimate, 1);
    }
    cv::circle(picture, at(truth[i]), 2, kTruth, cv::FILLED);
    cv::circle(picture, at(prior.nodes[i]), 2, prior.support[i] != 0 ? kEstimate : kUnsupported,
               cv::FILLED);
  }
  cv::Mat both;
  cv::hconcat(picture, plot_depths(truth, prior, picture.rows), both);
  return cv::imwrite(file, both);
}

}  // namespace flowdlo::lab
