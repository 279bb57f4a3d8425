#include "eval/plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>
#include <string>

#include "mat/mat_png.hpp"

namespace flowdlo::eval {
namespace {

struct Line {
  const char* method;
  const char* title;
  cv::Scalar color;  // BGR
};
const std::array<Line, 4> kLines{{{"prior", "thesis prior", {170, 170, 170}},
                                  {"refined", "refined prior", {200, 140, 40}},
                                  {"model", "model", {60, 160, 235}},
                                  {"estimate", "estimate", {60, 60, 200}}}};
const cv::Scalar kInk{40, 40, 40};
const cv::Scalar kGrid{225, 225, 225};
constexpr int kLeft = 90;
constexpr int kTop = 60;
constexpr int kBottom = 150;
constexpr int kPlotHeight = 420;
constexpr int kCurveWidth = 760;
constexpr double kLeast_cm = 0.01;  // of the logarithmic axes
constexpr double kMost_cm = 100;
constexpr double kDecades = 4;

void write(cv::Mat& picture, const std::string& text, cv::Point at, double size = 0.45) {
  cv::putText(picture, text, at, cv::FONT_HERSHEY_SIMPLEX, size, kInk, 1, cv::LINE_AA);
}

// In [0, 1] along a logarithmic axis.
double along(double cm) {
  return std::clamp(std::log10(std::max(cm, kLeast_cm) / kLeast_cm) / kDecades, 0.0, 1.0);
}

void draw_legend(cv::Mat& picture) {
  int x = kLeft;
  for (const Line& line : kLines) {
    cv::rectangle(picture, {x, 22, 14, 14}, line.color, cv::FILLED);
    write(picture, line.title, {x + 20, 34});
    x += 150;
  }
}

// cm, of the trials in which every method gave something.
std::map<std::string, std::vector<double>> errors_cm(std::span<const Trial* const> trials) {
  std::map<std::string, std::vector<double>> errors;
  for (const Trial* trial : trials) {
    for (const Line& line : kLines) {
      if (const Outcome* outcome = trial->of(line.method)) {
        errors[line.method].push_back(100 * outcome->index_m);
      }
    }
  }
  return errors;
}

// A label at 45 degrees would need a rotated font: long names take two lines instead.
void write_group(cv::Mat& picture, const std::string& name, std::size_t count, int x, int row) {
  const int y = kTop + kPlotHeight + 25 + 40 * (row % 3);
  write(picture, name, {x, y}, 0.42);
  write(picture, fmt::format("n = {}", count), {x, y + 15}, 0.38);
}

}  // namespace

Result<std::vector<std::uint8_t>> error_bars_png(std::span<const Trial> trials) {
  std::map<std::string, std::vector<const Trial*>> groups;
  for (const Trial& trial : trials) {
    if (!trial.methods.empty()) groups[trial.scene.scenario].push_back(&trial);
  }
  constexpr int kGroupWidth = 92;
  constexpr int kBarWidth = 17;
  const int width = std::max(760, kLeft + kGroupWidth * static_cast<int>(groups.size()) + 60);
  cv::Mat picture(kTop + kPlotHeight + kBottom, width, CV_8UC3, cv::Scalar::all(255));
  for (double cm = kLeast_cm; cm <= kMost_cm * 1.001; cm *= 10) {
    const int y = kTop + static_cast<int>(kPlotHeight * (1 - along(cm)));
    cv::line(picture, {kLeft, y}, {width - 20, y}, kGrid);
    write(picture, fmt::format("{:g} cm", cm), {12, y + 5});
  }
  int x = kLeft + 10;
  int row = 0;
  for (const auto& [name, members] : groups) {
    const auto errors = errors_cm(members);
    int left = x;
    for (const Line& line : kLines) {
      const auto found = errors.find(line.method);
      double sum = 0;
      if (found != errors.end()) {
        for (const double cm : found->second) sum += cm / static_cast<double>(found->second.size());
      }
      const int height = static_cast<int>(kPlotHeight * along(sum));
      cv::rectangle(picture, {left, kTop + kPlotHeight - height, kBarWidth, height}, line.color,
                    cv::FILLED);
      left += kBarWidth + 2;
    }
    write_group(picture, name, members.size(), x, row++);
    x += kGroupWidth;
  }
  draw_legend(picture);
  return mat::encode_png(picture);
}

Result<std::vector<std::uint8_t>> error_curve_png(std::span<const Trial> trials) {
  std::vector<const Trial*> members;
  for (const Trial& trial : trials) {
    if (!trial.methods.empty()) members.push_back(&trial);
  }
  cv::Mat picture(kTop + kPlotHeight + 70, kLeft + kCurveWidth + 40, CV_8UC3, cv::Scalar::all(255));
  const auto x_of = [](double cm) { return kLeft + static_cast<int>(kCurveWidth * along(cm)); };
  const auto y_of = [](double share) { return kTop + static_cast<int>(kPlotHeight * (1 - share)); };
  for (double cm = kLeast_cm; cm <= kMost_cm * 1.001; cm *= 10) {
    cv::line(picture, {x_of(cm), kTop}, {x_of(cm), kTop + kPlotHeight}, kGrid);
    write(picture, fmt::format("{:g} cm", cm), {x_of(cm) - 20, kTop + kPlotHeight + 22});
  }
  for (int tenth = 0; tenth <= 10; tenth += 2) {
    cv::line(picture, {kLeft, y_of(0.1 * tenth)}, {kLeft + kCurveWidth, y_of(0.1 * tenth)}, kGrid);
    write(picture, fmt::format("{} %", 10 * tenth), {30, y_of(0.1 * tenth) + 5});
  }
  auto errors = errors_cm(members);
  for (const Line& line : kLines) {
    auto& values = errors[line.method];
    std::sort(values.begin(), values.end());
    std::vector<cv::Point> curve;
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double share = static_cast<double>(i + 1) / static_cast<double>(values.size());
      curve.emplace_back(x_of(values[i]), y_of(share));
    }
    cv::polylines(picture, curve, false, line.color, 2, cv::LINE_AA);
  }
  write(picture, "share of frames with an index error (Eq. 4.1) below", {kLeft, kTop - 8}, 0.42);
  draw_legend(picture);
  return mat::encode_png(picture);
}

}  // namespace flowdlo::eval
