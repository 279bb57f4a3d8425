#include "path/reduced.hpp"

#include <cstdint>
#include <opencv2/imgproc.hpp>

#include "path/limits.hpp"

namespace flowdlo::path {
namespace {

constexpr int kAroundPx = 48;  // what lies beside the mask tells of occluders

}  // namespace

int reduction_of(const cv::Rect& box) {
  int times = 1;
  while (std::int64_t{box.width / times} * (box.height / times) > kMostTracedPixels) ++times;
  return times;
}

Reduced::Reduced(const Frame& frame, const cv::Rect& box, int times)
    : original_(frame.width, frame.height) {
  cv::Rect part = widened(box, kAroundPx, original_);
  part.width = std::max(1, part.width / times) * times;  // whole pixels: the last few may go
  part.height = std::max(1, part.height / times) * times;
  part &= cv::Rect({0, 0}, original_);
  const cv::Size size(std::max(1, part.width / times), std::max(1, part.height / times));
  window_ = {part, 1 / static_cast<float>(times)};
  camera_ = window_.camera(frame.intrinsics);
  cv::threshold(mask_in(frame, part), mask_, 127, 255, cv::THRESH_BINARY);
  cv::resize(mask_, mask_, size, 0, 0, cv::INTER_AREA);
  cv::threshold(mask_, mask_, 127, 255, cv::THRESH_BINARY);
  cv::resize(depth_in(frame, part), depth_m_, size, 0, 0, cv::INTER_NEAREST);
  if (frame.instances.empty()) return;
  cv::resize(instances_in(frame, part), instances_, size, 0, 0, cv::INTER_NEAREST);
}

Frame Reduced::frame() const { return frame_of(mask_, depth_m_, instances_, camera_); }

void Reduced::enlarge(Traversals& traversals) const { window_.restore(traversals, original_); }

void Reduced::enlarge(RopePaths& paths) const { window_.restore(paths, original_); }

}  // namespace flowdlo::path
