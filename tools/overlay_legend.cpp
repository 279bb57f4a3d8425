#include "overlay_legend.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "image/masks.hpp"
#include "pen.hpp"

namespace flowdlo::tools {
namespace {

constexpr std::size_t kLongestDevice = 34;
constexpr std::size_t kMostSwatches = 9;

struct Swatch {
  Color color;
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
  if (estimate.draws.empty()) return fmt::format("{} (model not asked)", words_of(estimate.origin));
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

/// "doubt: no depth, goes on".
std::string shown(const std::vector<Doubt>& doubts) {
  std::string result;
  for (const Doubt doubt : doubts) {
    result += (result.empty() ? "doubt: " : ", ") + std::string(name_of(doubt));
  }
  std::replace(result.begin(), result.end(), '_', ' ');
  return result;
}

Legend legend_of(const Estimate& estimate, const std::string& device) {
  const auto supported = std::count(estimate.support.begin(), estimate.support.end(), 1);
  Legend legend{{source_of(estimate),
                 fmt::format("confidence {:.2f}   mask agreement {:.2f}", estimate.confidence,
                             estimate.mask_agreement),
                 fmt::format("{}   {:.0f} ms", shown(device), estimate.timings.total_ms)},
                {{kSupportedColor, fmt::format("supported {}", supported)},
                 {kBridgedColor, fmt::format("bridged {}", kNodes - supported)}}};
  const auto& doubts = estimate.one_rope.doubts;
  if (!doubts.empty()) legend.lines.push_back(shown(doubts));
  return legend;
}

Legend legend_of(const TrackedRopes& tracked, const std::string& device) {
  const Ropes& ropes = tracked.found;
  float least = 1;
  for (const Estimate& rope : ropes.ropes) least = std::min(least, rope.confidence);
  const auto counted = [](std::size_t count, const char* what) {
    return fmt::format("{} {}{}", count, what, count == 1 ? "" : "s");
  };
  Legend legend{
      {counted(ropes.ropes.size(), "rope") + ", " + counted(ropes.crossings.size(), "crossing"),
       fmt::format("least confidence {:.2f}", least),
       fmt::format("{}   {:.0f} ms", shown(device), ropes.total_ms)},
      {}};
  for (std::size_t i = 0; i < std::min(ropes.ropes.size(), kMostSwatches); ++i) {
    legend.swatches.push_back(
        {rope_color(paint_index(tracked, i)), fmt::format("{}", shown_number(tracked, i))});
  }
  return legend;
}

// Lengths in capital letters' heights.
constexpr float kLineHeight = 1.9F;
constexpr float kPadding = 0.9F;
constexpr float kSwatch = 2.0F;

struct Metrics {
  explicit Metrics(const OverlayStyle& style)
      : lettering(style.in_legend),
        line_height_px(kLineHeight * lettering.height_px),
        padding_px(kPadding * lettering.height_px),
        swatch_px(kSwatch * lettering.height_px) {}

  [[nodiscard]] float width_of(const Swatch& swatch) const {
    return swatch_px + padding_px / 2 + lettering.width_px(swatch.text) + padding_px * 2;
  }

  Lettering lettering;
  float line_height_px;
  float padding_px;
  float swatch_px;
};

int whole(float length_px) { return static_cast<int>(std::lround(length_px)); }

image::Size size_of(const Legend& legend, const Metrics& metrics) {
  float width_px = 0;
  for (const auto& line : legend.lines) {
    width_px = std::max(width_px, metrics.lettering.width_px(line));
  }
  float swatches_px = legend.swatches.empty() ? 0 : -2 * metrics.padding_px;
  for (const auto& swatch : legend.swatches) swatches_px += metrics.width_of(swatch);
  width_px = std::max(width_px, swatches_px);
  const std::size_t rows = legend.lines.size() + (legend.swatches.empty() ? 0 : 1);
  return {whole(width_px + 2 * metrics.padding_px),
          whole(static_cast<float>(rows) * metrics.line_height_px + 2 * metrics.padding_px)};
}

// Top left first, so that an empty picture has it there.
image::Rect best_corner(const image::Size& size, const image::Mask& rope, int margin_px) {
  const int right = std::max(0, rope.width() - size.width - margin_px);
  const int below = std::max(0, rope.height() - size.height - margin_px);
  const std::array<image::Point, 4> corners = {
      {{margin_px, margin_px}, {right, margin_px}, {margin_px, below}, {right, below}}};
  image::Rect best;
  int least_covered = -1;
  for (const auto& corner : corners) {
    const auto box =
        image::Rect{corner.x, corner.y, size.width, size.height} & image::all_of(rope.size());
    if (box.empty()) continue;
    const int covered = image::count_set(rope.part(box));
    if (least_covered >= 0 && covered >= least_covered) continue;
    least_covered = covered;
    best = box;
  }
  return best;
}

void darken(support::Picture panel) {
  constexpr float kLeft = 0.3F;  // of each colour
  for (int v = 0; v < panel.height(); ++v) {
    for (int u = 0; u < panel.width(); ++u) {
      for (auto& value : panel.at(v, u)) {
        value = static_cast<std::uint8_t>(std::lround(kLeft * static_cast<float>(value)));
      }
    }
  }
}

void draw(const Legend& legend, support::Picture& picture, const image::Mask& rope,
          const OverlayStyle& style) {
  const Metrics metrics(style);
  const Lettering& lettering = metrics.lettering;
  const auto box = best_corner(size_of(legend, metrics), rope, whole(metrics.padding_px));
  if (box.empty()) return;
  darken(picture.part(box));

  Pen<Color> pen(picture);
  const float half_line_px = lettering.line_px / 2;
  Spot start{static_cast<float>(box.x) + metrics.padding_px + half_line_px,
             static_cast<float>(box.y) + metrics.padding_px +
                 (metrics.line_height_px + lettering.height_px) / 2};
  for (const auto& line : legend.lines) {
    pen.write(line, start, lettering, kTextColor);
    start.y += metrics.line_height_px;
  }
  for (const auto& swatch : legend.swatches) {
    const float middle = start.y - lettering.height_px / 2;
    const std::array ends{Spot{start.x + style.line_px / 2, middle},
                          Spot{start.x + metrics.swatch_px, middle}};
    pen.stroke(ends, style.line_px, swatch.color);
    pen.write(swatch.text,
              {start.x + metrics.swatch_px + metrics.padding_px / 2 + half_line_px, start.y},
              lettering, kTextColor);
    start.x += metrics.width_of(swatch);
  }
}

}  // namespace

void draw_legend(support::Picture& picture, const image::Mask& rope, const Estimate& estimate,
                 const std::string& device, const OverlayStyle& style) {
  draw(legend_of(estimate, device), picture, rope, style);
}

void draw_legend(support::Picture& picture, const image::Mask& rope, const std::string& words,
                 const OverlayStyle& style) {
  draw(Legend{{words}, {}}, picture, rope, style);
}

void draw_legend(support::Picture& picture, const image::Mask& rope, const TrackedRopes& tracked,
                 const std::string& device, const OverlayStyle& style) {
  draw(legend_of(tracked, device), picture, rope, style);
}

int shown_number(const TrackedRopes& tracked, std::size_t rope) {
  return tracked.numbers.empty() ? static_cast<int>(rope) : tracked.numbers[rope];
}

std::size_t paint_index(const TrackedRopes& tracked, std::size_t rope) {
  const int first = tracked.numbers.empty() ? 0 : 1;
  return static_cast<std::size_t>(shown_number(tracked, rope) - first);
}

}  // namespace flowdlo::tools
