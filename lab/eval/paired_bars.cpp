#include "eval/drawn_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "pictures/canvas.hpp"

namespace flowdlo::eval {
namespace {

constexpr const char* kBaseline = "trackdlo";
constexpr int kRow = 62;
constexpr int kNames = 210;
constexpr int kPanel = 460;
constexpr int kGap = 60;
constexpr int kTop = 70;
constexpr double kLeast_cm = 0.01;
constexpr double kDecades = 4;

struct Bar {
  const char* method;
  const char* title;
  cv::Scalar color;
};

std::vector<Bar> bars_of(const DataSet& data_set) {
  std::vector<Bar> bars{{kBaseline, "TrackDLO-init", pictures::kBaselineColor}};
  if (any_has(data_set.trials, "full"))
    bars.push_back({"full", "full model", pictures::draw_color(0)});
  bars.push_back({"estimate", "our estimate", pictures::kEstimateColor});
  return bars;
}

int length_of(double cm) {
  const double share = std::log10(std::max(cm, kLeast_cm) / kLeast_cm) / kDecades;
  return static_cast<int>(kPanel * std::clamp(share, 0.0, 1.0));
}

void draw_axis(const char* title, int left, int bottom, pictures::Canvas& canvas) {
  canvas.write(title, {left, kTop - 14}, 0.5);
  for (int decade = 0; decade <= static_cast<int>(kDecades); ++decade) {
    const double cm = kLeast_cm * std::pow(10.0, decade);
    const int x = left + length_of(cm);
    canvas.grid_line({x, kTop}, {x, bottom});
    canvas.write_centred(fmt::format("{:g}", cm), {x, bottom + 18}, 0.38);
  }
}

void draw_group(const SceneGroup& group, const std::vector<Bar>& bars, int y,
                pictures::Canvas& canvas) {
  std::vector<std::string> methods;
  int valid = 0;
  for (const Bar& bar : bars) methods.emplace_back(bar.method);
  for (const Trial* trial : group.trials) {
    const Account* account = trial->account(kBaseline);
    valid += account != nullptr && account->valid() ? 1 : 0;
  }
  canvas.write_left_of(group.name, {kNames - 10, y + 20});
  canvas.write_left_of(fmt::format("[{}/{}]", valid, group.trials.size()), {kNames - 10, y + 36},
                       0.38);
  const auto paired = having(group.trials, methods);
  for (std::size_t i = 0; i < bars.size() && !paired.empty(); ++i) {
    const MeanError error = mean_error(paired, bars[i].method);
    const std::array<double, 2> values{error.index_cm, error.frechet_cm};
    for (int side = 0; side < 2; ++side) {
      const double cm = values[static_cast<std::size_t>(side)];
      const cv::Rect place(kNames + side * (kPanel + kGap), y + 6 + 15 * static_cast<int>(i),
                           std::max(1, length_of(cm)), 12);
      cv::rectangle(canvas.picture(), place, bars[i].color, cv::FILLED);
      canvas.write(fmt::format("{:.2f}", cm), {place.x + place.width + 5, place.y + 10}, 0.34);
    }
  }
}

}  // namespace

Png paired_bars_png(const DataSet& data_set) {
  const auto groups = groups_of(data_set);
  const bool run = !groups.empty() && groups.back().trials.front()->account(kBaseline) != nullptr;
  if (!run) return std::vector<std::uint8_t>();
  const auto bars = bars_of(data_set);
  const int bottom = kTop + kRow * static_cast<int>(groups.size());
  pictures::Canvas canvas(kNames + 2 * kPanel + kGap + 60, bottom + 40);
  std::vector<std::pair<std::string, cv::Scalar>> entries;
  for (const Bar& bar : bars) entries.emplace_back(bar.title, bar.color);
  canvas.legend(entries, {kNames, 24});
  canvas.write("[valid / scenes] of TrackDLO-init", {kNames + 480, 24}, 0.38);
  draw_axis("mean index error (Eq. 4.1), cm", kNames, bottom, canvas);
  draw_axis("mean discrete Frechet distance (Eq. 4.2), cm", kNames + kPanel + kGap, bottom, canvas);
  int y = kTop;
  for (const SceneGroup& group : groups) {
    draw_group(group, bars, y, canvas);
    y += kRow;
  }
  return canvas.png();
}

}  // namespace flowdlo::eval
