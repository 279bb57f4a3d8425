#include "path/magnified.hpp"

#include <algorithm>
#include <cstddef>

namespace flowdlo::path {
namespace {

constexpr int kAroundPx = 24;  // what lies beside the mask tells of occluders

}  // namespace

Magnified::Magnified(const Frame& frame, const Region& region, int times)
    : times_(times), original_width_(frame.width), original_height_(frame.height) {
  const cv::Rect box(region.offset_px, region.mask.size());
  part_ = cv::Rect(box.x - kAroundPx, box.y - kAroundPx, box.width + 2 * kAroundPx,
                   box.height + 2 * kAroundPx) &
          cv::Rect(0, 0, frame.width, frame.height);
  region_ = magnified(region, times);
  region_.offset_px = times * (region.offset_px - part_.tl());
  const auto factor = static_cast<float>(times);
  const auto moved = [factor](float centre, int first) {
    return (centre - static_cast<float>(first) + 0.5F) * factor - 0.5F;
  };
  intrinsics_ = frame.intrinsics;
  intrinsics_.fx *= factor;
  intrinsics_.fy *= factor;
  intrinsics_.cx = moved(frame.intrinsics.cx, part_.x);
  intrinsics_.cy = moved(frame.intrinsics.cy, part_.y);
  const auto width = static_cast<std::size_t>(part_.width * times);
  const auto height = static_cast<std::size_t>(part_.height * times);
  depth_m_.reserve(width * height);
  mask_.reserve(width * height);
  for (int v = 0; v < part_.height * times; ++v) {
    const auto row = static_cast<std::size_t>(part_.y + v / times) * frame.width + part_.x;
    for (int u = 0; u < part_.width * times; ++u) {
      depth_m_.push_back(frame.depth_m[row + static_cast<std::size_t>(u / times)]);
      mask_.push_back(frame.mask[row + static_cast<std::size_t>(u / times)]);
    }
  }
}

Frame Magnified::frame() const {
  return {part_.width * times_, part_.height * times_, intrinsics_, depth_m_, mask_, {}};
}

std::vector<std::vector<Eigen::Vector2f>> Magnified::enlarged(
    std::vector<std::vector<Eigen::Vector2f>> lines) const {
  const Eigen::Vector2f half{0.5F, 0.5F};
  for (auto& line : lines) {
    for (Eigen::Vector2f& p : line) p = static_cast<float>(times_) * (p + half) - half;
  }
  return lines;
}

void Magnified::shrink(Traversals& traversals) const {
  const auto factor = static_cast<float>(times_);
  const Eigen::Vector2f first{static_cast<float>(part_.x), static_cast<float>(part_.y)};
  const Eigen::Vector2f half{0.5F, 0.5F};
  const Eigen::Vector2f last{static_cast<float>(original_width_ - 1),
                             static_cast<float>(original_height_ - 1)};
  traversals.rope_width_px /= factor;
  for (Path& path : traversals.ranked) {
    Path small;
    small.score = path.score;
    small.ring = path.ring;
    small.hidden_ends = path.hidden_ends;
    small.buried_ends = path.buried_ends;
    small.width_px = path.width_px / factor;
    for (std::size_t i = 0; i < path.points_px.size(); ++i) {
      const bool end = i == 0 || i + 1 == path.points_px.size();
      if (!end && i % static_cast<std::size_t>(times_) != 0) continue;
      const Eigen::Vector2f p = (path.points_px[i] + half) / factor - half + first;
      const Eigen::Vector2f inside = p.cwiseMax(Eigen::Vector2f::Zero()).cwiseMin(last);
      if (!small.points_px.empty() && small.points_px.back() == inside) continue;
      small.points_px.push_back(inside);
      small.bridged.push_back(path.bridged[i]);
    }
    path = std::move(small);
  }
}

}  // namespace flowdlo::path
