#include "pictures/panels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "mat/mat_file.hpp"

namespace flowdlo::pictures {
namespace {

constexpr int kWidth = 680;  // of a panel, px
constexpr int kHeight = 380;

const std::vector<cv::Scalar>& colours() {
  static const std::vector<cv::Scalar> list{{180, 119, 31}, {14, 127, 255},  {44, 160, 44},
                                            {40, 39, 214},  {189, 103, 148}, {75, 86, 140}};
  return list;
}

struct Range {
  double low = std::numeric_limits<double>::max();
  double high = std::numeric_limits<double>::lowest();

  void take(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  [[nodiscard]] double share(double value) const {
    return high > low ? (value - low) / (high - low) : 0.5;
  }
};

double scaled(double value, bool logarithmic) {
  return logarithmic ? std::log10(std::max(value, 1e-9)) : value;
}

void draw_text(cv::Mat& page, const std::string& text, cv::Point place, const cv::Scalar& colour) {
  cv::putText(page, text, place, cv::FONT_HERSHEY_SIMPLEX, 0.42, colour, 1, cv::LINE_AA);
}

void draw_line(cv::Mat& page, const Line& line, const cv::Rect& area, const Panel& panel,
               const Range& x, const Range& y, const cv::Scalar& colour) {
  std::vector<cv::Point> points;
  for (std::size_t i = 0; i < line.x.size(); ++i) {
    const double across = x.share(scaled(line.x[i], panel.logarithmic_x));
    const double up = y.share(scaled(line.y[i], panel.logarithmic));
    points.emplace_back(area.x + static_cast<int>(across * area.width),
                        area.y + area.height - static_cast<int>(up * area.height));
  }
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (line.dashed && i % 2 == 0) continue;
    cv::line(page, points[i - 1], points[i], colour, line.dashed ? 1 : 2, cv::LINE_AA);
  }
  if (!panel.marked || points.empty()) return;
  for (const cv::Point& point : points) {
    cv::circle(page, point, 3, colour, cv::FILLED, cv::LINE_AA);
  }
  draw_text(page, fmt::format("{:.4g}", line.y.back()), points.back() + cv::Point(-34, -8), colour);
}

void draw_panel(cv::Mat& page, const Panel& panel, const cv::Rect& box) {
  const cv::Rect area(box.x + 70, box.y + 34, box.width - 90, box.height - 70);
  Range x;
  Range y;
  for (const Line& line : panel.lines) {
    for (const double value : line.x) x.take(scaled(value, panel.logarithmic_x));
    for (const double value : line.y) y.take(scaled(value, panel.logarithmic));
  }
  if (panel.from_zero) y.take(0);
  if (x.high < x.low) x = {0, 1};
  if (y.high < y.low) y = {0, 1};
  const cv::Scalar ink(60, 60, 60);
  cv::rectangle(page, area, {200, 200, 200});
  draw_text(page, panel.title, {area.x, box.y + 22}, ink);
  const auto shown = [](double value, bool logarithmic) {
    return fmt::format("{:.4g}", logarithmic ? std::pow(10.0, value) : value);
  };
  draw_text(page, shown(y.high, panel.logarithmic), {box.x + 8, area.y + 10}, ink);
  draw_text(page, shown(y.low, panel.logarithmic), {box.x + 8, area.y + area.height}, ink);
  const auto whole = [](double value, bool logarithmic) {
    return fmt::format("{:.0f}", logarithmic ? std::pow(10.0, value) : value);
  };
  const int below = area.y + area.height + 18;
  draw_text(page, whole(x.low, panel.logarithmic_x), {area.x, below}, ink);
  const std::string end = panel.x_name + " " + whole(x.high, panel.logarithmic_x);
  draw_text(page, end, {area.x + area.width - 9 * static_cast<int>(end.size()), below}, ink);
  for (std::size_t i = 0; i < panel.lines.size(); ++i) {
    const cv::Scalar& colour = colours()[i % colours().size()];
    draw_line(page, panel.lines[i], area, panel, x, y, colour);
    draw_text(page, panel.lines[i].name + (panel.lines[i].dashed ? " (dashed)" : ""),
              {panel.marked ? area.x + 12 : area.x + area.width - 210,
               area.y + 18 + 16 * static_cast<int>(i)},
              colour);
  }
}

}  // namespace

Result<void> save_panels(std::span<const Panel> panels, const std::filesystem::path& file) {
  const int rows = static_cast<int>(panels.size() + 1) / 2;
  cv::Mat page(rows * kHeight, 2 * kWidth, CV_8UC3, cv::Scalar(255, 255, 255));
  for (int i = 0; i < static_cast<int>(panels.size()); ++i) {
    draw_panel(page, panels[static_cast<std::size_t>(i)],
               {(i % 2) * kWidth, (i / 2) * kHeight, kWidth, kHeight});
  }
  return mat::save_png(file, page);
}

}  // namespace flowdlo::pictures
