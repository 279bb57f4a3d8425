#include "path/window.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "path/limits.hpp"
#include "path/strokes.hpp"

namespace flowdlo::path {
namespace {

using Eigen::Vector2f;

const Vector2f kHalf{0.5F, 0.5F};
// What lies beside the mask tells of occluders.
constexpr int kAroundMagnifiedPx = 24;
constexpr int kAroundReducedPx = 48;

// Samples about a pixel apart of those that lie `pace` pixels apart; where a link begins or ends
// between two of them, the new one belongs to it.
Path respaced(const Path& path, float pace) {
  Path result = path;
  result.points_px.clear();
  result.bridged.clear();
  const auto add = [&](const Vector2f& p, std::uint8_t bridged) {
    if (!result.points_px.empty() && result.points_px.back() == p) return;
    result.points_px.push_back(p);
    result.bridged.push_back(bridged);
  };
  const std::size_t count = path.points_px.size();
  const auto every = static_cast<std::size_t>(std::max(1.0F, std::round(1 / pace)));
  const int pieces = std::max(1, static_cast<int>(std::lround(pace)));
  for (std::size_t i = 0; i < count; ++i) {
    const bool end = i == 0 || i + 1 == count;
    if (!end && i % every != 0) continue;
    for (int k = 1; i > 0 && k < pieces; ++k) {
      const float t = static_cast<float>(k) / static_cast<float>(pieces);
      add((1 - t) * path.points_px[i - 1] + t * path.points_px[i],
          std::max(path.bridged[i - 1], path.bridged[i]));
    }
    add(path.points_px[i], path.bridged[i]);
  }
  return result;
}

template <class Pixel>
cv::Mat copied(std::span<const Pixel> pixels, int width, const cv::Rect& part, int type) {
  cv::Mat copy(part.size(), type);
  for (int v = 0; v < part.height; ++v) {
    const auto row = static_cast<std::size_t>(part.y + v) * static_cast<std::size_t>(width);
    const auto first = pixels.subspan(row + static_cast<std::size_t>(part.x),
                                      static_cast<std::size_t>(part.width));
    std::copy(first.begin(), first.end(), copy.ptr<Pixel>(v));
  }
  return copy;
}

// What is reduced of a frame: whole pixels of the copy; the last few of the original may go.
cv::Rect whole_pixels(const cv::Rect& box, int times, const cv::Size& frame) {
  cv::Rect part = widened(box, kAroundReducedPx, frame);
  part.width = std::max(1, part.width / times) * times;
  part.height = std::max(1, part.height / times) * times;
  return part & cv::Rect({0, 0}, frame);
}

// The smallest divisor of its sides that leaves the box no more than so many pixels.
int times_to_fit(const cv::Rect& box, int pixels) {
  int times = 1;
  while (std::int64_t{box.width / times} * (box.height / times) > pixels) ++times;
  return times;
}

cv::Mat times_larger(const cv::Mat& image, int times) {
  cv::Mat large;
  cv::resize(image, large, image.size() * times, 0, 0, cv::INTER_NEAREST);
  return large;
}

}  // namespace

Intrinsics Window::camera(const Intrinsics& frame) const {
  const auto moved = [this](float centre, int first) {
    return (centre - static_cast<float>(first) + 0.5F) * scale - 0.5F;
  };
  return {frame.fx * scale, frame.fy * scale, moved(frame.cx, part.x), moved(frame.cy, part.y)};
}

Vector2f Window::place_of(const Vector2f& p) const {
  const Vector2f first{static_cast<float>(part.x), static_cast<float>(part.y)};
  return scale * (p - first + kHalf) - kHalf;
}

void Window::restore(Path& path, const cv::Size& frame) const {
  const Vector2f first{static_cast<float>(part.x), static_cast<float>(part.y)};
  const Vector2f last{static_cast<float>(frame.width - 1), static_cast<float>(frame.height - 1)};
  path.width_px /= scale;
  for (Vector2f& p : path.points_px) {
    p = ((p + kHalf) / scale - kHalf + first).cwiseMax(Vector2f::Zero()).cwiseMin(last);
  }
  path = respaced(path, 1 / scale);
}

void Window::restore(Traversals& traversals, const cv::Size& frame) const {
  traversals.rope_width_px /= scale;
  for (Path& path : traversals.ranked) restore(path, frame);
}

void Window::restore(RopePaths& paths, const cv::Size& frame) const {
  paths.rope_width_px /= scale;
  for (Path& path : paths.ropes) restore(path, frame);
  for (RopesGuess& guess : paths.guesses) {
    for (Path& path : guess.ropes) restore(path, frame);
  }
}

cv::Mat mask_in(const Frame& frame, const cv::Rect& part) {
  return copied(frame.mask, frame.width, part, CV_8U);
}

cv::Mat depth_in(const Frame& frame, const cv::Rect& part) {
  return copied(frame.depth_m, frame.width, part, CV_32F);
}

cv::Mat instances_in(const Frame& frame, const cv::Rect& part) {
  if (frame.instances.empty()) return {};
  return copied(frame.instances, frame.width, part, CV_16U);
}

Frame frame_of(const cv::Mat& mask, const cv::Mat& depth_m, const cv::Mat& instances,
               const Intrinsics& camera) {
  Frame frame{mask.cols,
              mask.rows,
              camera,
              {depth_m.ptr<float>(), depth_m.total()},
              {mask.ptr<std::uint8_t>(), mask.total()},
              {}};
  if (!instances.empty()) frame.instances = {instances.ptr<std::uint16_t>(), instances.total()};
  return frame;
}

cv::Rect widened(const cv::Rect& box, int around_px, const cv::Size& frame) {
  return cv::Rect(box.x - around_px, box.y - around_px, box.width + 2 * around_px,
                  box.height + 2 * around_px) &
         cv::Rect({0, 0}, frame);
}

Rescaled::Rescaled(const Frame& original, const Window& window)
    : window_(window),
      original_(original.width, original.height),
      camera_(window.camera(original.intrinsics)) {}

Frame Rescaled::frame() const { return frame_of(mask_, depth_m_, instances_, camera_); }

Magnified::Magnified(const Frame& frame, const Region& region, int times)
    : Rescaled(frame, {widened({region.offset_px, region.mask.size()}, kAroundMagnifiedPx,
                               {frame.width, frame.height}),
                       static_cast<float>(times)}) {
  region_ = magnified(region, times);
  region_.offset_px = times * (region.offset_px - window_.part.tl());
  depth_m_ = times_larger(depth_in(frame, window_.part), times);
  mask_ = times_larger(mask_in(frame, window_.part), times);
  if (frame.instances.empty()) return;
  instances_ = times_larger(instances_in(frame, window_.part), times);
}

std::vector<std::vector<Vector2f>> Magnified::enlarged(
    std::vector<std::vector<Vector2f>> lines) const {
  for (auto& line : lines) {
    for (Vector2f& p : line) p = window_.scale * (p + kHalf) - kHalf;
  }
  return lines;
}

int reduction_of(const Frame& frame, const cv::Rect& box) {
  const int least = times_to_fit(box, kMostTracedPixels);
  const int most = times_to_fit(box, kAlwaysTracedPixels);
  if (least == most) return least;
  cv::Mat mask;
  cv::copyMakeBorder(mask_in(frame, box) > 127, mask, 1, 1, 1, 1, cv::BORDER_CONSTANT, {});
  mask &= 1;
  const std::int64_t length_px = stroke_length_px(mask);
  if (length_px > std::int64_t{kMostStrokeSides} * (frame.width + frame.height)) return most;
  // Along a diagonal a stroke is longer than it has border pixels.
  const float most_px = std::numbers::sqrt2_v<float> * static_cast<float>(length_px);
  const float width_px = static_cast<float>(cv::countNonZero(mask)) / most_px;
  return std::clamp(static_cast<int>(width_px / kThickPx), least, most);
}

Reduced::Reduced(const Frame& frame, const cv::Rect& box, int times)
    : Rescaled(frame, {whole_pixels(box, times, {frame.width, frame.height}),
                       1 / static_cast<float>(times)}) {
  const cv::Rect& part = window_.part;
  const cv::Size size(std::max(1, part.width / times), std::max(1, part.height / times));
  cv::threshold(mask_in(frame, part), mask_, 127, 255, cv::THRESH_BINARY);
  cv::resize(mask_, mask_, size, 0, 0, cv::INTER_AREA);
  cv::threshold(mask_, mask_, 127, 255, cv::THRESH_BINARY);
  cv::resize(depth_in(frame, part), depth_m_, size, 0, 0, cv::INTER_NEAREST);
  if (frame.instances.empty()) return;
  cv::resize(instances_in(frame, part), instances_, size, 0, 0, cv::INTER_NEAREST);
}

}  // namespace flowdlo::path
