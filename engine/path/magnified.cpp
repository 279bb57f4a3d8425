#include "path/magnified.hpp"

#include <opencv2/imgproc.hpp>

namespace flowdlo::path {
namespace {

constexpr int kAroundPx = 24;  // what lies beside the mask tells of occluders

cv::Mat times_larger(const cv::Mat& image, int times) {
  cv::Mat large;
  cv::resize(image, large, image.size() * times, 0, 0, cv::INTER_NEAREST);
  return large;
}

}  // namespace

Magnified::Magnified(const Frame& frame, const Region& region, int times)
    : original_(frame.width, frame.height) {
  const cv::Rect box(region.offset_px, region.mask.size());
  window_ = {widened(box, kAroundPx, original_), static_cast<float>(times)};
  camera_ = window_.camera(frame.intrinsics);
  region_ = magnified(region, times);
  region_.offset_px = times * (region.offset_px - window_.part.tl());
  depth_m_ = times_larger(depth_in(frame, window_.part), times);
  mask_ = times_larger(mask_in(frame, window_.part), times);
  if (frame.instances.empty()) return;
  instances_ = times_larger(instances_in(frame, window_.part), times);
}

Frame Magnified::frame() const { return frame_of(mask_, depth_m_, instances_, camera_); }

std::vector<std::vector<Eigen::Vector2f>> Magnified::enlarged(
    std::vector<std::vector<Eigen::Vector2f>> lines) const {
  const Eigen::Vector2f half{0.5F, 0.5F};
  for (auto& line : lines) {
    for (Eigen::Vector2f& p : line) p = window_.scale * (p + half) - half;
  }
  return lines;
}

void Magnified::shrink(Traversals& traversals) const { window_.restore(traversals, original_); }

void Magnified::shrink(RopePaths& paths) const { window_.restore(paths, original_); }

}  // namespace flowdlo::path
