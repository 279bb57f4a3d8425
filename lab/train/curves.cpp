// Curves: the log's columns drawn with OpenCV, four panels on one page.
#include "train/curves.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>

namespace flowdlo::train {
namespace {

struct Line {
  std::string name;
  std::vector<double> x;
  std::vector<double> y;
  bool dashed = false;
};

struct Panel {
  std::string title;
  bool logarithmic = false;
  std::vector<Line> lines;
};

const std::vector<cv::Scalar>& colours() {
  static const std::vector<cv::Scalar> list{{180, 119, 31}, {14, 127, 255},  {44, 160, 44},
                                            {40, 39, 214},  {189, 103, 148}, {75, 86, 140}};
  return list;
}

using Row = std::map<std::string, std::string>;

std::vector<Row> read_rows(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::vector<std::string> names;
  std::vector<Row> rows;
  while (std::getline(stream, line)) {
    std::vector<std::string> cells;
    std::stringstream parts(line);
    for (std::string cell; std::getline(parts, cell, ',');) cells.push_back(cell);
    if (names.empty()) {
      names = cells;
      continue;
    }
    if (cells.size() != names.size()) continue;
    Row row;
    for (std::size_t i = 0; i < names.size(); ++i) row[names[i]] = cells[i];
    rows.push_back(std::move(row));
  }
  return rows;
}

double number(const Row& row, const std::string& name) {
  const auto found = row.find(name);
  return found == row.end() ? 0.0 : std::atof(found->second.c_str());
}

/// One column over the steps, averaged so that a few hundred points remain.
Line column(const std::vector<Row>& rows, const std::string& name) {
  constexpr std::size_t kMost = 400;
  const std::size_t stride = std::max<std::size_t>(1, rows.size() / kMost);
  Line line{name, {}, {}};
  for (std::size_t first = 0; first + stride <= rows.size(); first += stride) {
    double sum = 0;
    for (std::size_t i = first; i < first + stride; ++i) sum += number(rows[i], name);
    line.x.push_back(number(rows[first + stride - 1], "step"));
    line.y.push_back(sum / static_cast<double>(stride));
  }
  return line;
}

Line group_line(const std::vector<Row>& rows, const std::string& group, const std::string& name,
                bool dashed) {
  Line line{group + " " + name, {}, {}, dashed};
  for (const Row& row : rows) {
    if (row.at("group") != group) continue;
    line.x.push_back(number(row, "step"));
    line.y.push_back(number(row, name));
  }
  return line;
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
    const double across = x.share(line.x[i]);
    const double up = y.share(scaled(line.y[i], panel.logarithmic));
    points.emplace_back(area.x + static_cast<int>(across * area.width),
                        area.y + area.height - static_cast<int>(up * area.height));
  }
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (line.dashed && i % 2 == 0) continue;
    cv::line(page, points[i - 1], points[i], colour, line.dashed ? 1 : 2, cv::LINE_AA);
  }
}

void draw_panel(cv::Mat& page, const Panel& panel, const cv::Rect& box) {
  const cv::Rect area(box.x + 70, box.y + 34, box.width - 90, box.height - 70);
  Range x;
  Range y;
  for (const Line& line : panel.lines) {
    for (const double value : line.x) x.take(value);
    for (const double value : line.y) y.take(scaled(value, panel.logarithmic));
  }
  if (x.high < x.low) x = {0, 1};
  if (y.high < y.low) y = {0, 1};
  const cv::Scalar ink(60, 60, 60);
  cv::rectangle(page, area, {200, 200, 200});
  draw_text(page, panel.title, {area.x, box.y + 22}, ink);
  const auto shown = [&](double value) {
    return fmt::format("{:.3g}", panel.logarithmic ? std::pow(10.0, value) : value);
  };
  draw_text(page, shown(y.high), {box.x + 8, area.y + 10}, ink);
  draw_text(page, shown(y.low), {box.x + 8, area.y + area.height}, ink);
  draw_text(page, fmt::format("{:.0f}", x.low), {area.x, area.y + area.height + 18}, ink);
  draw_text(page, fmt::format("step {:.0f}", x.high),
            {area.x + area.width - 70, area.y + area.height + 18}, ink);
  for (std::size_t i = 0; i < panel.lines.size(); ++i) {
    const cv::Scalar& colour = colours()[i % colours().size()];
    draw_line(page, panel.lines[i], area, panel, x, y, colour);
    draw_text(page, panel.lines[i].name + (panel.lines[i].dashed ? " (dashed)" : ""),
              {area.x + area.width - 210, area.y + 18 + 16 * static_cast<int>(i)}, colour);
  }
}

}  // namespace

Result<void> plot_curves(const std::filesystem::path& folder) {
  const auto steps = read_rows(folder / "steps.csv");
  const auto checks = read_rows(folder / "validation.csv");
  std::vector<Panel> panels(4);
  panels[0] = {"training losses",
               true,
               {column(steps, "primary"), column(steps, "prior"), column(steps, "harm")}};
  panels[1] = {"shape and sigma terms", false, {column(steps, "spacing"), column(steps, "sigma")}};
  panels[2] = {"validation: mean index error, cm (prior dashed)", false, {}};
  panels[3] = {"validation: model / prior", false, {}};
  for (const char* group : {"all", "easy", "hard"}) {
    panels[2].lines.push_back(group_line(checks, group, "model_cm", false));
    panels[2].lines.push_back(group_line(checks, group, "prior_cm", true));
    panels[3].lines.push_back(group_line(checks, group, "ratio", false));
  }
  constexpr int kWidth = 680;
  constexpr int kHeight = 380;
  cv::Mat page(2 * kHeight, 2 * kWidth, CV_8UC3, cv::Scalar(255, 255, 255));
  for (int i = 0; i < 4; ++i) {
    draw_panel(page, panels[static_cast<std::size_t>(i)],
               {(i % 2) * kWidth, (i / 2) * kHeight, kWidth, kHeight});
  }
  const auto temporary = folder / ".curves.tmp.png";
  std::error_code failed;
  const bool written = cv::imwrite(temporary.string(), page);
  if (written) std::filesystem::rename(temporary, folder / "curves.png", failed);
  if (written && !failed) return {};
  return Error{ErrorCode::kIo, fmt::format("{}: expected a writable folder; check the path",
                                           (folder / "curves.png").string())};
}

}  // namespace flowdlo::train
