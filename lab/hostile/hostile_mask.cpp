#include "hostile/hostile_mask.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <opencv2/imgproc.hpp>

namespace flowdlo::lab {
namespace {

using cv::Mat;
using cv::Point;

const cv::Scalar kLit(255);
constexpr std::uint64_t kSeed = 14;

template <class Inside>
void light_where(Mat& mask, const Inside& inside) {
  for (int v = 0; v < mask.rows; ++v) {
    auto* row = mask.ptr<std::uint8_t>(v);
    for (int u = 0; u < mask.cols; ++u) row[u] = inside(u, v) ? 255 : 0;
  }
}

/// As wide as a rope is in most frames: an 80th of the image.
int rope_width(const Mat& mask) { return std::max(2, mask.cols / 80); }

/// Percent of the pixels.
void noise(Mat& mask, int percent) {
  cv::RNG random(kSeed);
  light_where(mask, [&](int, int) { return random.uniform(0, 100) < percent; });
}

/// Half of the image in blobs about that many pixels across.
void blobs(Mat& mask, int across_px) {
  noise(mask, 50);
  cv::boxFilter(mask, mask, CV_8U, {across_px, across_px});
  mask = mask > 127;
}

/// Squares of that many pixels.
void checker(Mat& mask, int side_px) {
  light_where(mask, [&](int u, int v) { return (u / side_px + v / side_px) % 2 == 0; });
}

/// Lines a third as wide as they are apart, in pixels.
void grid(Mat& mask, int pitch_px) {
  const int line_px = std::max(1, pitch_px / 3);
  light_where(mask, [&](int u, int v) { return u % pitch_px < line_px || v % pitch_px < line_px; });
}

/// Turns that many pixels apart, half of it lit.
void spiral(Mat& mask, int pitch_px) {
  const double centre_u = 0.5 * mask.cols;
  const double centre_v = 0.5 * mask.rows;
  light_where(mask, [&](int u, int v) {
    const double radius = std::hypot(u - centre_u, v - centre_v);
    const double turn = std::atan2(v - centre_v, u - centre_u) / (2 * std::numbers::pi);
    const double at = radius / pitch_px - turn;
    return at - std::floor(at) < 0.5;
  });
}

/// Lines of text that many pixels high.
void text(Mat& mask, int height_px) {
  const double scale = height_px / 22.0;
  for (int v = height_px, line = 0; v < mask.rows + height_px; v += height_px + 4, ++line) {
    std::string words;
    for (int k = 0; k < mask.cols / std::max(2, height_px / 3); ++k) {
      words.push_back(static_cast<char>('!' + (7 * k + 13 * line) % 90));
    }
    cv::putText(mask, words, {0, v}, cv::FONT_HERSHEY_SIMPLEX, scale, kLit,
                std::max(1, height_px / 12));
  }
}

/// Teeth that many pixels wide on one spine.
void comb(Mat& mask, int tooth_px) {
  const int spine_px = 3 * tooth_px;
  light_where(mask, [&](int u, int v) { return v < spine_px || u / tooth_px % 2 == 0; });
}

/// That many lines one pixel wide.
void hairs(Mat& mask, int count) {
  cv::RNG random(kSeed);
  const auto anywhere = [&] {
    return Point(random.uniform(0, mask.cols), random.uniform(0, mask.rows));
  };
  for (int i = 0; i < count; ++i) {
    const Point from = anywhere();
    cv::line(mask, from, anywhere(), kLit, 1);
  }
}

/// Discs that many pixels apart.
void dots(Mat& mask, int pitch_px) {
  const int radius_px = std::max(1, pitch_px / 3);
  light_where(mask, [&](int u, int v) {
    const int du = u % pitch_px - pitch_px / 2;
    const int dv = v % pitch_px - pitch_px / 2;
    return du * du + dv * dv <= radius_px * radius_px;
  });
}

/// Sierpinski's triangle, in cells of that many pixels.
void triangle(Mat& mask, int cell_px) {
  light_where(mask, [&](int u, int v) { return ((u / cell_px) & (v / cell_px)) == 0; });
}

/// Sierpinski's carpet, in cells of that many pixels.
void carpet(Mat& mask, int cell_px) {
  light_where(mask, [&](int u, int v) {
    for (int a = u / cell_px, b = v / cell_px; a > 0 || b > 0; a /= 3, b /= 3) {
      if (a % 3 == 1 && b % 3 == 1) return false;
    }
    return true;
  });
}

/// Where Hilbert's curve over a square of 2^k cells is after `step` steps.
Point hilbert_cell(int side, int step) {
  Point p(0, 0);
  for (int s = 1; s < side; s *= 2, step /= 4) {
    const int right = 1 & (step / 2);
    const int up = 1 & (step ^ right);
    if (up == 0) {
      if (right == 1) p = {s - 1 - p.x, s - 1 - p.y};
      std::swap(p.x, p.y);
    }
    p += Point(s * right, s * up);
  }
  return p;
}

/// Hilbert's curve, one line that fills the image, its strands that many pixels apart.
void hilbert(Mat& mask, int pitch_px) {
  int side = 1;
  while (2 * side * pitch_px <= std::min(mask.cols, mask.rows)) side *= 2;
  Point before = hilbert_cell(side, 0);
  const auto place = [&](const Point& cell) {
    return Point(cell.x * pitch_px + pitch_px / 2, cell.y * pitch_px + pitch_px / 2);
  };
  for (int step = 1; step < side * side; ++step) {
    const Point cell = hilbert_cell(side, step);
    cv::line(mask, place(before), place(cell), kLit, std::max(1, pitch_px / 2));
    before = cell;
  }
}

/// All of the image but that many percent at each border.
void full(Mat& mask, int border_percent) {
  const int aside = mask.cols * border_percent / 100;
  const int above = mask.rows * border_percent / 100;
  mask(cv::Rect(aside, above, mask.cols - 2 * aside, mask.rows - 2 * above)) = 255;
}

/// A disc that takes that many percent of the image's shorter side.
void disc(Mat& mask, int percent) {
  const int radius_px = std::max(1, std::min(mask.cols, mask.rows) * percent / 200);
  cv::circle(mask, {mask.cols / 2, mask.rows / 2}, radius_px, kLit, cv::FILLED);
}

void wave(Mat& mask, double height, double amplitude, double turns, double phase) {
  std::vector<Point> points;
  for (int k = 0; k <= 200; ++k) {
    const double along = k / 200.0;
    const double off = amplitude * std::sin(2 * std::numbers::pi * (turns * along + phase));
    points.emplace_back(cvRound((0.05 + 0.9 * along) * mask.cols),
                        cvRound((height + off) * mask.rows));
  }
  cv::polylines(mask, points, false, kLit, rope_width(mask));
}

/// That many ropes beside each other.
void ropes(Mat& mask, int count) {
  for (int i = 0; i < count; ++i) wave(mask, (i + 0.5) / count, 0.2 / count, 2, 0.1 * i);
}

/// That many ropes over each other.
void tangle(Mat& mask, int count) {
  cv::RNG random(kSeed);
  for (int i = 0; i < count; ++i) {
    wave(mask, random.uniform(0.2, 0.8), random.uniform(0.02, 0.3), random.uniform(0.5, 4.0),
         random.uniform(0.0, 1.0));
  }
}

/// One rope under that many percent of noise.
void ragged(Mat& mask, int percent) {
  Mat rope = Mat::zeros(mask.size(), CV_8U);
  wave(rope, 0.5, 0.25, 1.5, 0);
  noise(mask, percent);
  mask ^= rope;
}

struct Family {
  std::string_view name;
  void (*draw)(Mat& mask, int amount);
  std::vector<int> amounts;
  bool lines = false;  ///< it holds something that could be a rope
};

const std::vector<Family>& families() {
  static const std::vector<Family> list = {
      {"noise", noise, {1, 5, 10, 20, 30, 40, 50, 60, 80, 95}},
      {"blobs", blobs, {3, 9, 27}},
      {"checker", checker, {1, 2, 8, 33}},
      {"grid", grid, {6, 20, 80}},
      {"spiral", spiral, {8, 40}, true},
      {"text", text, {12, 40}},
      {"comb", comb, {2}},
      {"hairs", hairs, {20, 400}, true},
      {"dots", dots, {6, 14}},
      {"triangle", triangle, {1}},
      {"carpet", carpet, {1}},
      {"hilbert", hilbert, {4}, true},
      {"full", full, {0, 3}},
      {"disc", disc, {60}},
      {"ropes", ropes, {2, 12}, true},
      {"tangle", tangle, {6, 60}, true},
      {"ragged", ragged, {3}, true},
  };
  return list;
}

}  // namespace

std::string HostileMask::name() const {
  return std::string(family) + "_" + std::to_string(amount) + "_" + std::to_string(size_px.width) +
         "x" + std::to_string(size_px.height);
}

std::vector<cv::Size> hostile_sizes() {
  return {{64, 64}, {640, 480}, {1280, 720}, {1920, 1080}, {4096, 4096}};
}

std::vector<HostileMask> hostile_corpus() {
  std::vector<HostileMask> corpus;
  for (const cv::Size& size_px : hostile_sizes()) {
    for (const Family& family : families()) {
      for (const int amount : family.amounts) corpus.push_back({family.name, amount, size_px});
    }
  }
  return corpus;
}

std::vector<HostileMask> ropeless_masks(const cv::Size& size_px) {
  std::vector<HostileMask> masks;
  for (const Family& family : families()) {
    if (family.lines) continue;
    for (const int amount : family.amounts) masks.push_back({family.name, amount, size_px});
  }
  return masks;
}

cv::Mat draw(const HostileMask& mask) {
  Mat image = Mat::zeros(mask.size_px, CV_8U);
  for (const Family& family : families()) {
    if (family.name == mask.family) family.draw(image, mask.amount);
  }
  return image;
}

cv::Mat draw_ordinary(const cv::Size& size_px) {
  Mat image = Mat::zeros(size_px, CV_8U);
  wave(image, 0.5, 0.25, 1.5, 0);
  return image;
}

}  // namespace flowdlo::lab
