#include "eval/drawn_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <opencv2/imgproc.hpp>

#include "eval/contenders.hpp"
#include "pictures/canvas.hpp"

namespace flowdlo::eval {
namespace {

struct Line {
  const char* model;
  const char* title;
  cv::Scalar color;
  const ThesisSweep* thesis;
};
const std::array<Line, 2> kLines{
    {{"full", "velocity", pictures::draw_color(0), &kThesisVelocity},
     {"direct", "direct state", pictures::draw_color(1), &kThesisDirect}}};
constexpr int kLeft = 70;
constexpr int kTop = 50;
constexpr int kPlotWidth = 520;
constexpr int kPlotHeight = 320;

std::vector<double> errors_cm(const DataSet& data_set, const char* model) {
  std::vector<double> errors;
  for (const int steps : kSweep) {
    const MeanError error = mean_error(data_set.trials, swept(model, steps));
    if (error.scenes > 0) errors.push_back(error.index_cm);
  }
  return errors.size() == std::size(kSweep) ? errors : std::vector<double>();
}

cv::Point plot_point(int steps, double cm, double most_cm) {
  const double along = std::log(static_cast<double>(steps)) / std::log(kSweep[3]);
  return {kLeft + static_cast<int>(along * kPlotWidth),
          kTop + static_cast<int>((1 - cm / most_cm) * kPlotHeight)};
}

void draw_line(const std::vector<double>& errors, const cv::Scalar& color, bool thesis,
               double most_cm, pictures::Canvas& canvas) {
  for (std::size_t i = 0; i < errors.size(); ++i) {
    const cv::Point here = plot_point(kSweep[i], errors[i], most_cm);
    cv::circle(canvas.picture(), here, thesis ? 3 : 4, color, thesis ? 1 : cv::FILLED, cv::LINE_AA);
    if (i == 0) continue;
    const cv::Point before = plot_point(kSweep[i - 1], errors[i - 1], most_cm);
    cv::line(canvas.picture(), before, here, color, thesis ? 1 : 2, cv::LINE_AA);
  }
}

}  // namespace

Png sweep_plot_png(const DataSet& data_set) {
  double most_cm = 0;
  for (const Line& line : kLines) {
    for (const double cm : errors_cm(data_set, line.model)) most_cm = std::max(most_cm, cm);
    if (data_set.thesis_groups) most_cm = std::max(most_cm, line.thesis->index_cm[0]);
  }
  if (errors_cm(data_set, "full").empty() && errors_cm(data_set, "direct").empty()) {
    return std::vector<std::uint8_t>();
  }
  most_cm *= 1.1;
  pictures::Canvas canvas(kLeft + kPlotWidth + 40, kTop + kPlotHeight + 50);
  for (int i = 0; i <= 4; ++i) {
    const int y = kTop + i * kPlotHeight / 4;
    canvas.grid_line({kLeft, y}, {kLeft + kPlotWidth, y});
    canvas.write_left_of(fmt::format("{:.2f}", most_cm * (4 - i) / 4), {kLeft - 8, y + 4}, 0.38);
  }
  for (const int steps : kSweep) {
    const cv::Point foot = plot_point(steps, 0, most_cm);
    canvas.grid_line({foot.x, kTop}, foot);
    canvas.write_centred(fmt::format("K = {}", steps), {foot.x, foot.y + 20});
  }
  canvas.write("index error, cm", {8, kTop - 30}, 0.38);
  std::vector<std::pair<std::string, cv::Scalar>> entries;
  for (const Line& line : kLines) {
    draw_line(errors_cm(data_set, line.model), line.color, false, most_cm, canvas);
    entries.emplace_back(line.title, line.color);
    if (!data_set.thesis_groups) continue;
    const auto& thesis = line.thesis->index_cm;
    draw_line({thesis.begin(), thesis.end()}, line.color, true, most_cm, canvas);
  }
  canvas.legend(entries, {kLeft + 80, 20});
  if (data_set.thesis_groups)
    canvas.write("thin, hollow: the thesis' own", {kLeft + 300, 20}, 0.38);
  return canvas.png();
}

}  // namespace flowdlo::eval
