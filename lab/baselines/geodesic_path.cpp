#include "baselines/traced_path.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include "baselines/zhang_suen.hpp"

namespace flowdlo::baselines {
namespace {

constexpr float kUnreached = std::numeric_limits<float>::infinity();

// Distances along the skeleton from one pixel, and the way back to it.
struct Reach {
  std::vector<float> distance;
  std::vector<int> before;
  int farthest = -1;
};

Reach reach_from(const cv::Mat& skeleton, int start) {
  const auto size = static_cast<std::size_t>(skeleton.total());
  Reach reach{std::vector<float>(size, kUnreached), std::vector<int>(size, -1), start};
  using Entry = std::pair<float, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  reach.distance[static_cast<std::size_t>(start)] = 0;
  queue.emplace(0.0F, start);
  while (!queue.empty()) {
    const auto [distance, pixel] = queue.top();
    queue.pop();
    if (distance > reach.distance[static_cast<std::size_t>(pixel)]) continue;
    reach.farthest = pixel;  // the queue gives pixels in order of distance
    const int v = pixel / skeleton.cols;
    const int u = pixel % skeleton.cols;
    for (int dv = -1; dv <= 1; ++dv) {
      for (int du = -1; du <= 1; ++du) {
        const int y = v + dv;
        const int x = u + du;
        if (y < 0 || x < 0 || y >= skeleton.rows || x >= skeleton.cols) continue;
        if (skeleton.at<std::uint8_t>(y, x) == 0) continue;
        const int next = y * skeleton.cols + x;
        const float there = distance + std::hypot(static_cast<float>(dv), static_cast<float>(du));
        if (!(there < reach.distance[static_cast<std::size_t>(next)])) continue;
        reach.distance[static_cast<std::size_t>(next)] = there;
        reach.before[static_cast<std::size_t>(next)] = pixel;
        queue.emplace(there, next);
      }
    }
  }
  return reach;
}

Stroke way_back(const Reach& reach, int columns) {
  Stroke stroke;
  for (int pixel = reach.farthest; pixel >= 0;
       pixel = reach.before[static_cast<std::size_t>(pixel)]) {
    stroke.emplace_back(static_cast<float>(pixel % columns), static_cast<float>(pixel / columns));
  }
  return stroke;
}

}  // namespace

Result<Stroke> geodesic_path(const cv::Mat& mask) {
  cv::Mat left = zhang_suen(mask);
  Stroke best;
  for (int start = 0; start < static_cast<int>(left.total()); ++start) {
    if (left.at<std::uint8_t>(start / left.cols, start % left.cols) == 0) continue;
    const Reach first = reach_from(left, start);
    Stroke stroke = way_back(reach_from(left, first.farthest), left.cols);
    if (length_px(stroke) > length_px(best)) best = std::move(stroke);
    for (int pixel = 0; pixel < static_cast<int>(left.total()); ++pixel) {  // component is done
      if (first.distance[static_cast<std::size_t>(pixel)] < kUnreached) {
        left.at<std::uint8_t>(pixel / left.cols, pixel % left.cols) = 0;
      }
    }
  }
  if (best.size() < 2) return Error{ErrorCode::kNoPath, "mask holds no line"};
  return best;
}

}  // namespace flowdlo::baselines
