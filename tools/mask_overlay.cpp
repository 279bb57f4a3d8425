#include "mask_overlay.hpp"

#include <cmath>

#include "frame_picture.hpp"
#include "image/brush.hpp"
#include "image/masks.hpp"
#include "overlay_style.hpp"

namespace flowdlo::tools {
namespace {

constexpr double kDimmed = 0.45;  ///< of a pixel's grey beside the mask
constexpr Color kPaper = support::color_of(40);
constexpr Color kRope = support::color_of(200);

Color dimmed(const Color& color) {
  return support::color_of(
      static_cast<std::uint8_t>(std::lrint(kDimmed * support::grey_of(color))));
}

}  // namespace

support::Picture draw_mask_overlay(const Frame& frame) {
  const auto mask = image::above(mask_of(frame), 127, 255);
  const auto grown = image::dilated(mask, 1);
  const auto colors = colors_of(frame);
  support::Picture picture(mask.size());
  for (int v = 0; v < picture.height(); ++v) {
    for (int u = 0; u < picture.width(); ++u) {
      Color& pixel = picture.at(v, u);
      if (mask.at(v, u) != 0) {
        pixel = colors.empty() ? kRope : colors.at(v, u);
      } else if (grown.at(v, u) != 0) {
        pixel = kSupportedColor;
      } else {
        pixel = colors.empty() ? kPaper : dimmed(colors.at(v, u));
      }
    }
  }
  return picture;
}

}  // namespace flowdlo::tools
