// The overlay's colours (BGR) and sizes. Teal and orange stay apart for the colour-blind.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "pen.hpp"
#include "picture.hpp"

namespace flowdlo::tools {

using support::Color;

inline constexpr Color kSupportedColor{196, 212, 32};
inline constexpr Color kBridgedColor{0, 140, 255};
inline constexpr Color kRimColor{24, 16, 12};
inline constexpr Color kMaskOutlineColor{235, 235, 235};
inline constexpr Color kTextColor{240, 240, 240};
inline constexpr Color kWhite{255, 255, 255};

/// Of one of several ropes, by its index; they begin again after nine.
inline const Color& rope_color(std::size_t rope) {
  static constexpr std::array<Color, 9> kColors{{{196, 212, 32},
                                                 {60, 160, 255},
                                                 {255, 130, 90},
                                                 {90, 230, 90},
                                                 {230, 110, 230},
                                                 {60, 230, 245},
                                                 {255, 235, 150},
                                                 {130, 130, 255},
                                                 {190, 190, 190}}};
  return kColors[rope % kColors.size()];
}

/// Sizes in pixels of the picture; they grow with it.
struct OverlayStyle {
  explicit OverlayStyle(int picture_width_px)
      : scale(std::max(0.75F, static_cast<float>(picture_width_px) / 640.0F)),
        line_px(2.6F * (1 + scale)),
        rim_px(std::max(1.0F, scale)),
        marker_radius_px(8.5F * scale),
        outline_px(std::max(1.0F, 0.6F * scale)),
        on_markers{9.5F * scale, 1.3F * scale},
        in_legend{9.0F * std::pow(scale, 0.75F), 1.05F * std::pow(scale, 0.75F)} {}

  /// Of the curve with the rim on its two sides.
  [[nodiscard]] float rimmed_px() const { return line_px + 2 * rim_px; }

  float scale;
  float line_px;
  float rim_px;
  float marker_radius_px;
  float outline_px;
  Lettering on_markers;
  Lettering in_legend;  ///< it may grow more slowly than the picture
};

}  // namespace flowdlo::tools
