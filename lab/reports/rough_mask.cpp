#include "reports/rough_mask.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "flowdlo/mask.hpp"
#include "geometry/camera.hpp"
#include "one_rope/part_of_rope.hpp"
#include "scene/random.hpp"

namespace flowdlo::lab {
namespace {

cv::Mat view(FrameFolder& frame) { return {frame.height, frame.width, CV_8UC1, frame.mask.data()}; }

cv::Mat disc(double radius_px) {
  const int side = 2 * std::max(1, static_cast<int>(std::lround(radius_px))) + 1;
  return cv::getStructuringElement(cv::MORPH_ELLIPSE, {side, side});
}

/// The mask eroded or dilated by a disc.
Roughness grown(int by, const char* name, double widths) {
  return {cv::format("%s by %.2f", name, widths),
          [=](const FrameFolder& frame, double width_px, std::uint64_t) {
            FrameFolder out = frame;
            cv::Mat mask = view(out);
            cv::morphologyEx(mask, mask, by, disc(widths * width_px));
            return out;
          }};
}

Roughness shifted(double widths) {
  return {"shifted by " + cv::format("%.2f", widths),
          [=](const FrameFolder& frame, double width_px, std::uint64_t seed) {
            FrameFolder out = frame;
            Random random(seed);
            const double angle = random.uniform(0, 2 * CV_PI);
            const double by_px = widths * width_px;
            const cv::Mat move = (cv::Mat_<double>(2, 3) << 1, 0, by_px * std::cos(angle), 0, 1,
                                  by_px * std::sin(angle));
            cv::Mat moved;
            cv::warpAffine(view(out), moved, move, view(out).size(), cv::INTER_NEAREST);
            moved.copyTo(view(out));
            return out;
          }};
}

/// Discs at random pixels of the mask, painted `value`, until the mask's area has changed by
/// `share`. Beside the rope: centres a width off its axis.
FrameFolder spotted(const FrameFolder& frame, double radius_px, double share, std::uint8_t value,
                    std::uint64_t seed) {
  FrameFolder out = frame;
  cv::Mat mask = view(out);
  std::vector<cv::Point> places;
  cv::findNonZero(mask, places);
  if (places.empty()) return out;
  const auto area = static_cast<double>(places.size());
  Random random(seed);
  for (int spot = 0; spot < 10000; ++spot) {
    const double changed = std::abs(cv::countNonZero(mask) - area) / area;
    if (changed >= share) break;
    const auto at = static_cast<std::size_t>(random.uniform(0, 1) * (area - 1));
    cv::Point place = places[at];
    if (value != 0) {
      const double angle = random.uniform(0, 2 * CV_PI);
      place += cv::Point(static_cast<int>(2 * radius_px * std::cos(angle)),
                         static_cast<int>(2 * radius_px * std::sin(angle)));
    }
    cv::circle(mask, place, std::max(1, static_cast<int>(std::lround(radius_px))), value, -1);
  }
  return out;
}

/// Spots whose radius is `widths` of the rope's.
Roughness spots(const char* name, double widths, std::uint8_t value, double share) {
  return {cv::format("%s %.0f %%", name, 100 * share),
          [=](const FrameFolder& frame, double width_px, std::uint64_t seed) {
            return spotted(frame, widths * width_px, share, value, seed);
          }};
}

Roughness part(std::string name, double from, double to) {
  return {std::move(name), [=](const FrameFolder& frame, double, std::uint64_t) {
            return part_of_rope(frame, from, to);
          }};
}

/// The rope between a quarter and a half of its length is not in the mask.
Roughness gap() {
  return {"a quarter missing within", [](const FrameFolder& frame, double, std::uint64_t) {
            FrameFolder out = part_of_rope(frame, 0, 0.35);
            const FrameFolder rest = part_of_rope(frame, 0.6, 1);
            for (std::size_t i = 0; i < out.mask.size(); ++i) out.mask[i] |= rest.mask[i];
            return out;
          }};
}

Roughness filled(std::string name, int least) {
  return {std::move(name), [=](const FrameFolder& frame, double, std::uint64_t seed) {
            FrameFolder out = frame;
            Random random(seed);
            for (auto& pixel : out.mask) pixel = random.uniform(0, 256) >= least ? 255 : 0;
            return out;
          }};
}

FrameFolder with(const FrameFolder& frame, const Result<Mask>& mask) {
  FrameFolder out = frame;
  if (mask) {
    out.mask = *mask;
  } else {
    out.mask.assign(out.mask.size(), 0);
  }
  return out;
}

/// Somebody clicks on the rope at four places, where they lie in the image.
Roughness clicked() {
  return {"flowdlo mask --click, 4 times", [](const FrameFolder& frame, double, std::uint64_t) {
            std::vector<Pixel> clicks;
            for (const std::size_t node : {8U, 24U, 40U, 56U}) {
              const auto at = geometry::project(frame.intrinsics, (*frame.truth)[node]);
              const auto u = std::lround(at.x());
              const auto v = std::lround(at.y());
              if (u < 0 || v < 0 || u >= frame.width || v >= frame.height) continue;
              const auto pixel = static_cast<std::size_t>(v) * frame.width + u;
              if (frame.mask[pixel] > 127) clicks.push_back({at.x(), at.y()});
            }
            return with(frame, mask_from_seeds(frame.frame(), clicks));
          }};
}

Roughness on_table() {
  return {"flowdlo mask --table", [](const FrameFolder& frame, double, std::uint64_t) {
            return with(frame, mask_from_plane(frame.frame(), {}));
          }};
}

}  // namespace

std::vector<Roughness> roughnesses() {
  std::vector<Roughness> all{
      {"as it came", [](const FrameFolder& frame, double, std::uint64_t) { return frame; }}};
  for (const double widths : {0.1, 0.2, 0.3}) {
    all.push_back(grown(cv::MORPH_ERODE, "eroded", widths));
  }
  for (const double widths : {0.25, 0.5, 1.0}) {
    all.push_back(grown(cv::MORPH_DILATE, "dilated", widths));
  }
  for (const double widths : {0.25, 0.5, 1.0}) all.push_back(shifted(widths));
  for (const double share : {0.1, 0.25, 0.5}) all.push_back(spots("holes over", 0.35, 0, share));
  for (const double share : {0.1, 0.25, 0.5}) {
    all.push_back(spots("bleeding, +", 0.7, 255, share));
  }
  all.push_back(gap());
  all.push_back(part("an end missing, 15 %", 0, 0.85));
  all.push_back(part("half missing", 0, 0.5));
  all.push_back(clicked());
  all.push_back(on_table());
  all.push_back(filled("all 255", 0));
  all.push_back(filled("noise, half of it 255", 128));
  return all;
}

}  // namespace flowdlo::lab
