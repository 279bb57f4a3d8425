#include "path/window.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <utility>

#include "image/masks.hpp"
#include "image/resize.hpp"
#include "path/limits.hpp"
#include "path/strokes.hpp"

namespace flowdlo::path {
namespace {

using Eigen::Vector2f;

const Vector2f kHalf{0.5F, 0.5F};
constexpr int kAroundPx = 48;  // what lies beside the mask tells of occluders

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
image::Image<Pixel> copied(std::span<const Pixel> pixels, const Frame& frame,
                           const image::Rect& part) {
  const image::Image<const Pixel> whole(pixels.data(), {frame.width, frame.height}, frame.width);
  return whole.part(part).clone();
}

// What is reduced of a frame: whole pixels of the copy; the last few of the original may go.
image::Rect whole_pixels(const image::Rect& box, int times, const image::Size& frame) {
  image::Rect part = image::grown(box, kAroundPx) & image::all_of(frame);
  part.width = std::max(1, part.width / times) * times;
  part.height = std::max(1, part.height / times) * times;
  return part & image::all_of(frame);
}

// The smallest divisor of its sides that leaves the box no more than so many pixels.
int times_to_fit(const image::Rect& box, int pixels) {
  int times = 1;
  while (std::int64_t{box.width / times} * (box.height / times) > pixels) ++times;
  return times;
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

void Window::restore(Path& path, const image::Size& frame) const {
  const Vector2f first{static_cast<float>(part.x), static_cast<float>(part.y)};
  const Vector2f last{static_cast<float>(frame.width - 1), static_cast<float>(frame.height - 1)};
  path.width_px /= scale;
  for (Vector2f& p : path.points_px) {
    p = ((p + kHalf) / scale - kHalf + first).cwiseMax(Vector2f::Zero()).cwiseMin(last);
  }
  path = respaced(path, 1 / scale);
}

void Window::restore(Traversals& traversals, const image::Size& frame) const {
  traversals.rope_width_px /= scale;
  for (Path& path : traversals.ranked) restore(path, frame);
}

void Window::restore(RopePaths& paths, const image::Size& frame) const {
  paths.rope_width_px /= scale;
  for (Path& path : paths.ropes) restore(path, frame);
  for (RopesGuess& guess : paths.guesses) {
    for (Path& path : guess.ropes) restore(path, frame);
  }
}

int reduction_of(const Frame& frame, const image::Rect& box) {
  const int least = times_to_fit(box, kMostTracedPixels);
  const int most = times_to_fit(box, kAlwaysTracedPixels);
  if (least == most) return least;
  image::Mask mask(image::grown(box, 1).size(), 0);
  const image::Mask within = copied(frame.mask, frame, box);
  for (int v = 0; v < box.height; ++v) {
    std::transform(
        within.row(v), within.row(v) + box.width, mask.row(v + 1) + 1,
        [](std::uint8_t value) { return value > 127 ? std::uint8_t{1} : std::uint8_t{0}; });
  }
  const std::int64_t length_px = stroke_length_px(mask);
  if (length_px > std::int64_t{kMostStrokeSides} * (frame.width + frame.height)) return most;
  // Along a diagonal a stroke is longer than it has border pixels.
  const float most_px = std::numbers::sqrt2_v<float> * static_cast<float>(length_px);
  const float width_px = static_cast<float>(image::count_set(mask)) / most_px;
  return std::clamp(static_cast<int>(width_px / kThickPx), least, most);
}

Reduced::Reduced(const Frame& frame, const image::Rect& box, int times)
    : window_{whole_pixels(box, times, {frame.width, frame.height}), 1 / static_cast<float>(times)},
      original_{frame.width, frame.height},
      camera_(window_.camera(frame.intrinsics)) {
  const image::Rect& part = window_.part;
  const image::Size size{std::max(1, part.width / times), std::max(1, part.height / times)};
  const image::Mask full = image::above(copied(frame.mask, frame, part), 127, 255);
  mask_ = image::above(image::area_mean<std::uint8_t>(full, size), 127, 255);
  depth_m_ = image::nearest<float>(copied(frame.depth_m, frame, part), size);
  if (frame.instances.empty()) return;
  instances_ = image::nearest<std::uint16_t>(copied(frame.instances, frame, part), size);
}

Frame Reduced::frame() const {
  Frame frame{mask_.width(),
              mask_.height(),
              camera_,
              {depth_m_.data(), depth_m_.total()},
              {mask_.data(), mask_.total()},
              {}};
  if (!instances_.empty()) frame.instances = {instances_.data(), instances_.total()};
  return frame;
}

}  // namespace flowdlo::path
