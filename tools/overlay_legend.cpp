#include "overlay_legend.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace flowdlo::tools {
namespace {

constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr std::size_t kLongestDevice = 34;
constexpr std::size_t kMostSwatches = 9;

struct Swatch {
  cv::Scalar color;
  std::string text;
};

struct Legend {
  std::vector<std::string> lines;
  std::vector<Swatch> swatches;  ///< one line, below the others
};

const char* words_of(Origin prior) {
  switch (prior) {
    case Origin::kRunnerUp:
      return "runner-up's prior";
    case Origin::kOtherReading:
      return "other reading's prior";
    case Origin::kFrameBefore:
      return "as in the frame before";
    default:
      return "first prior";
  }
}

/// Where the curve is from; a prior is chosen for want of a plausible draw, or over one.
std::string source_of(const Estimate& estimate) {
  if (estimate.source == Source::kPrediction) {
    return fmt::format("prediction (draw {} of {})", estimate.draw + 1, estimate.draws.size());
  }
  const bool any = std::any_of(estimate.draws.begin(), estimate.draws.end(),
                               [](const DrawReport& draw) { return draw.accepted; });
  return fmt::format("{} ({})", words_of(estimate.origin),
                     any ? "likelier than the draws" : "no draw passed the gate");
}

std::string shown(const std::string& device) {
  std::string result = device.substr(0, kLongestDevice);
  if (result.size() < device.size()) result += "...";
  return result;
}

Legend legend_of(const Estimate& estimate, const std::string& device) {
  const auto supported = std::count(estimate.support.begin(), estimate.support.end(), 1);
  return {{source_of(estimate),
           fmt::format("confidence {:.2f}   mask agreement {:.2f}", estimate.confidence,
                       estimate.mask_agreement),
           fmt::format("{}   {:.0f} ms", shown(device), estimate.timings.total_ms)},
          {{kSupportedColor, fmt::format("supported {}", supported)},
           {kBridgedColor, fmt::format("bridged {}", kNodes - supported)}}};
}

Legend legend_of(const Ropes& ropes, const std::string& device) {
  float least = 1;
  for (const Estimate& rope : ropes.ropes) least = std::min(least, rope.confidence);
  Legend legend{{fmt::format("{} ropes, {} crossings", ropes.ropes.size(), ropes.crossings.size()),
                 fmt::format("least confidence {:.2f}", least),
                 fmt::format("{}   {:.0f} ms", shown(device), ropes.total_ms)},
                {}};
  for (std::size_t i = 0; i < std::min(ropes.ropes.size(), kMostSwatches); ++i) {
    legend.swatches.push_back({rope_color(i), fmt::format("{}", i)});
  }
  return legend;
}

struct Metrics {
  explicit Metrics(const OverlayStyle& style)
      : font_scale(style.text_scale),
        thickness(OverlayStyle::rounded(2.1F * style.text_scale)),
        line_height_px(OverlayStyle::rounded(40.0F * style.text_scale)),
        padding_px(OverlayStyle::rounded(19.0F * style.text_scale)),
        swatch_px(OverlayStyle::rounded(42.0F * style.text_scale)) {}

  [[nodiscard]] int width_of(const std::string& text) const {
    int baseline = 0;
    return cv::getTextSize(text, kFont, font_scale, thickness, &baseline).width;
  }
  [[nodiscard]] int width_of(const Swatch& swatch) const {
    return swatch_px + padding_px / 2 + width_of(swatch.text) + padding_px * 2;
  }

  double font_scale;
  int thickness;
  int line_height_px;
  int padding_px;
  int swatch_px;
};

cv::Size size_of(const Legend& legend, const Metrics& metrics) {
  int width = 0;
  for (const auto& line : legend.lines) width = std::max(width, metrics.width_of(line));
  int swatches = 0;
  for (const auto& swatch : legend.swatches) swatches += metrics.width_of(swatch);
  width = std::max(width, swatches);
  const auto rows = static_cast<int>(legend.lines.size()) + 1;
  return {width + 2 * metrics.padding_px, rows * metrics.line_height_px + 2 * metrics.padding_px};
}

// Top left first, so that an empty picture has it there.
cv::Rect best_corner(const cv::Size& size, const cv::Mat& rope, int margin_px) {
  const int right = std::max(0, rope.cols - size.width - margin_px);
  const int below = std::max(0, rope.rows - size.height - margin_px);
  const std::array<cv::Point, 4> corners = {
      {{margin_px, margin_px}, {right, margin_px}, {margin_px, below}, {right, below}}};
  const cv::Rect picture(0, 0, rope.cols, rope.rows);
  cv::Rect best;
  int least_covered = -1;
  for (const auto& corner : corners) {
    const cv::Rect box = cv::Rect(corner, size) & picture;
    if (box.empty()) continue;
    const int covered = cv::countNonZero(rope(box));
    if (least_covered >= 0 && covered >= least_covered) continue;
    least_covered = covered;
    best = box;
  }
  return best;
}

void draw(const Legend& legend, cv::Mat& picture, const cv::Mat& rope, const OverlayStyle& style) {
  const Metrics metrics(style);
  const auto box = best_corner(size_of(legend, metrics), rope, metrics.padding_px);
  if (box.empty()) return;
  cv::Mat panel = picture(box);
  panel.convertTo(panel, -1, 0.3, 0);

  const int left = box.x + metrics.padding_px;
  int baseline = box.y + metrics.padding_px + metrics.line_height_px * 3 / 4;
  for (const auto& line : legend.lines) {
    cv::putText(picture, line, {left, baseline}, kFont, metrics.font_scale, kTextColor,
                metrics.thickness, cv::LINE_AA);
    baseline += metrics.line_height_px;
  }
  int at = left;
  for (const auto& swatch : legend.swatches) {
    const int middle = baseline - metrics.line_height_px / 4;
    cv::line(picture, {at + style.line_px, middle}, {at + metrics.swatch_px, middle}, swatch.color,
             style.line_px, cv::LINE_AA);
    cv::putText(picture, swatch.text, {at + metrics.swatch_px + metrics.padding_px / 2, baseline},
                kFont, metrics.font_scale, kTextColor, metrics.thickness, cv::LINE_AA);
    at += metrics.width_of(swatch);
  }
}

}  // namespace

void draw_legend(cv::Mat& picture, const cv::Mat& rope, const Estimate& estimate,
                 const std::string& device, const OverlayStyle& style) {
  draw(legend_of(estimate, device), picture, rope, style);
}

void draw_legend(cv::Mat& picture, const cv::Mat& rope, const std::string& words,
                 const OverlayStyle& style) {
  draw(Legend{{words}, {}}, picture, rope, style);
}

void draw_legend(cv::Mat& picture, const cv::Mat& rope, const Ropes& ropes,
                 const std::string& device, const OverlayStyle& style) {
  draw(legend_of(ropes, device), picture, rope, style);
}

}  // namespace flowdlo::tools
