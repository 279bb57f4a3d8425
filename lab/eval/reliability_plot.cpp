#include "eval/drawn_figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "eval/coverage_tables.hpp"
#include "pictures/canvas.hpp"

namespace flowdlo::eval {
namespace {

constexpr int kLeft = 70;
constexpr int kTop = 64;
constexpr int kSide = 380;
constexpr int kCounts = 70;  // height of the bars below

}  // namespace

Png reliability_png(const DataSet& data_set) {
  const auto bins = reliability(data_set.trials);
  if (bins.empty()) return std::vector<std::uint8_t>();
  pictures::Canvas canvas(kLeft + kSide + 50, kTop + kSide + kCounts + 70);
  const auto at = [](double said, double was) {
    return cv::Point(kLeft + static_cast<int>(said * kSide),
                     kTop + static_cast<int>((1 - was) * kSide));
  };
  for (int fifth = 0; fifth <= 5; ++fifth) {
    const double share = 0.2 * fifth;
    canvas.grid_line(at(share, 0), at(share, 1));
    canvas.grid_line(at(0, share), at(1, share));
    canvas.write_left_of(fmt::format("{} %", 20 * fifth), at(0, share) + cv::Point(-8, 4), 0.38);
    canvas.write_centred(fmt::format("{:.1f}", share), at(share, 0) + cv::Point(0, 18), 0.38);
  }
  cv::line(canvas.picture(), at(0, 0), at(1, 1), pictures::kPriorColor, 1, cv::LINE_AA);
  int most = 1;
  for (const ReliabilityBin& bin : bins) most = std::max(most, bin.scenes);
  const int floor = kTop + kSide + 30 + kCounts;
  for (std::size_t i = 0; i < bins.size(); ++i) {
    const ReliabilityBin& bin = bins[i];
    const cv::Point here = at(bin.said, bin.was);
    const int radius = 3 + static_cast<int>(7 * std::sqrt(static_cast<double>(bin.scenes) / most));
    if (i > 0) {
      cv::line(canvas.picture(), at(bins[i - 1].said, bins[i - 1].was), here,
               pictures::kEstimateColor, 1, cv::LINE_AA);
    }
    cv::circle(canvas.picture(), here, radius, pictures::kEstimateColor, cv::FILLED, cv::LINE_AA);
    const int height = kCounts * bin.scenes / most;
    cv::rectangle(canvas.picture(), {here.x - 10, floor - height, 20, std::max(1, height)},
                  pictures::kEstimateColor, cv::FILLED);
    canvas.write_centred(std::to_string(bin.scenes), {here.x, floor + 16}, 0.36);
  }
  canvas.write("share of estimates with an index error under 1 cm", {kLeft - 50, kTop - 42}, 0.42);
  canvas.write(fmt::format("expected calibration error {:.3f}", expected_calibration_error(bins)),
               {kLeft - 50, kTop - 22}, 0.38);
  canvas.write_centred("confidence, and scenes that say it", {kLeft + kSide / 2, floor + 34}, 0.38);
  return canvas.png();
}

}  // namespace flowdlo::eval
