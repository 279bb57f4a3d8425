#include "frame_picture.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "image/distance.hpp"
#include "image/masks.hpp"
#include "image/resize.hpp"
#include "overlay_style.hpp"

namespace flowdlo::tools {
namespace {

using support::Picture;
using Three = std::array<float, 3>;

constexpr int kNarrowest_px = 480;
constexpr int kLongest_px = 4096;

int zoom_of(const Frame& frame) {
  const int wanted = (kNarrowest_px + frame.width - 1) / frame.width;
  return std::max(1, std::min(wanted, kLongest_px / std::max(frame.width, frame.height)));
}

std::uint8_t byte_of(float value) {
  return static_cast<std::uint8_t>(std::clamp(std::lrint(value), 0L, 255L));
}

/// `share` of `over`, the rest of `below`.
Color mixed(const Color& below, const Color& over, float share) {
  Color result{};
  for (std::size_t c = 0; c < result.size(); ++c) {
    const auto from = static_cast<float>(below[c]);
    result[c] = byte_of(from + share * (static_cast<float>(over[c]) - from));
  }
  return result;
}

/// Each pixel as a square of `zoom` pixels a side.
template <class Pixel>
image::Image<Pixel> enlarged(const image::Image<Pixel>& image, int zoom) {
  if (zoom == 1) return image;
  image::Image<Pixel> result(image.size() * zoom);
  for (int v = 0; v < result.height(); ++v) {
    const Pixel* const from = image.row(v / zoom);
    Pixel* const to = result.row(v);
    for (int u = 0; u < result.width(); ++u) to[u] = from[u / zoom];
  }
  return result;
}

/// 1 at the pixels of `mask` that have a side in common with one that is none, or with the image's
/// border.
image::Mask border_of(const image::Mask& mask) {
  const image::Rect whole = image::all_of(mask.size());
  const auto set = [&](int v, int u) { return whole.contains({u, v}) && mask.at(v, u) != 0; };
  image::Mask border(mask.size());
  for (int v = 0; v < mask.height(); ++v) {
    for (int u = 0; u < mask.width(); ++u) {
      const bool within = set(v - 1, u) && set(v + 1, u) && set(v, u - 1) && set(v, u + 1);
      border.at(v, u) = set(v, u) && !within ? 1 : 0;
    }
  }
  return border;
}

// As wide as the style's lines, with soft sides. An operation on the image: a mask of a million
// pieces costs no more than one of one.
void draw_outline(Picture& picture, const image::Mask& mask, const OverlayStyle& style) {
  constexpr float kOpacity = 0.6F;
  constexpr float kBeside = 0.34F;  // of the colour, one pixel beside a line one pixel wide
  const float reach_px = 0.5F * (style.outline_px - 1) + 1 + kBeside;
  const auto border = border_of(mask);
  if (image::count_set(border) == 0) return;
  const auto away_px = image::distance_to_empty(image::inverse(border));
  for (int v = 0; v < picture.height(); ++v) {
    for (int u = 0; u < picture.width(); ++u) {
      const float share = std::clamp(reach_px - away_px.at(v, u), 0.0F, 1.0F);
      if (share == 0) continue;
      picture.at(v, u) = mixed(picture.at(v, u), kMaskOutlineColor, kOpacity * share);
    }
  }
}

/// What the strand field says of its pixels: a colour, already weighed, and its weight.
struct Paint {
  image::Image<Three> color;
  image::Image<float> weight;
};

// How near an axis is says how much of its colour a pixel takes, the direction says which colour.
// Channels are engine/field/channel.hpp's.
Paint paint_of(const SeenStrands& strands) {
  enum Channel : std::size_t { kCentre, kCos, kSin, kTip };
  const image::Size size{strands.width, strands.height};
  Paint paint{image::Image<Three>(size), image::Image<float>(size)};
  const std::size_t pixels = paint.weight.total();
  for (std::size_t i = 0; i < pixels; ++i) {
    const auto at = [&](Channel channel) { return strands.channels[channel * pixels + i]; };
    const float length = std::max(1e-3F, std::hypot(at(kCos), at(kSin)));
    const float tip = std::clamp(at(kTip), 0.0F, 1.0F);
    const float weight = std::clamp(std::max(at(kCentre), tip), 0.0F, 1.0F);
    const Three of_axis{127.5F * (1 + at(kCos) / length), 127.5F * (1 + at(kSin) / length), 255};
    paint.weight.data()[i] = weight;
    for (std::size_t c = 0; c < of_axis.size(); ++c) {
      paint.color.data()[i][c] = weight * ((1 - tip) * of_axis[c] + tip * 255);
    }
  }
  return paint;
}

}  // namespace

support::ConstPicture colors_of(const Frame& frame) {
  if (frame.color_bgr.empty()) return {};
  return {reinterpret_cast<const Color*>(frame.color_bgr.data()),
          {frame.width, frame.height},
          frame.width};
}

image::Image<const std::uint8_t> mask_of(const Frame& frame) {
  return {frame.mask.data(), {frame.width, frame.height}, frame.width};
}

support::Picture paled(const Frame& frame) {
  constexpr float kOfColor = 0.45F;
  constexpr float kOfGrey = 0.25F;
  constexpr Color kRope = support::color_of(129);
  constexpr Color kPaper = support::color_of(40);
  const auto colors = colors_of(frame);
  const auto mask = mask_of(frame);
  Picture picture(mask.size());
  for (int v = 0; v < picture.height(); ++v) {
    for (int u = 0; u < picture.width(); ++u) {
      Color& pixel = picture.at(v, u);
      if (colors.empty()) {
        pixel = mask.at(v, u) > 127 ? kRope : kPaper;
        continue;
      }
      const Color& color = colors.at(v, u);
      const float grey = kOfGrey * static_cast<float>(support::grey_of(color));
      for (std::size_t c = 0; c < pixel.size(); ++c) {
        pixel[c] = byte_of(kOfColor * static_cast<float>(color[c]) + grey);
      }
    }
  }
  return picture;
}

void tint(support::Picture& picture, const SeenStrands& strands) {
  if (strands.channels.empty()) return;
  const auto side = [](int seen, float scale) {
    return std::max(1, static_cast<int>(std::lrint(static_cast<float>(seen) / scale)));
  };
  const image::Rect whole{strands.first_u, strands.first_v, side(strands.width, strands.scale_u),
                          side(strands.height, strands.scale_v)};
  const image::Rect part = whole & image::all_of(picture.size());
  if (part.empty()) return;
  const Paint paint = paint_of(strands);
  const auto color = image::area_mean<Three>(paint.color, whole.size());
  const auto weight = image::area_mean<float>(paint.weight, whole.size());
  for (int v = part.y; v < part.y + part.height; ++v) {
    for (int u = part.x; u < part.x + part.width; ++u) {
      const image::Point at = image::Point{u, v} - whole.corner();
      Color& pixel = picture.at(v, u);
      for (std::size_t c = 0; c < pixel.size(); ++c) {
        pixel[c] = byte_of((1 - weight.at(at)) * static_cast<float>(pixel[c]) + color.at(at)[c]);
      }
    }
  }
}

Ground ground_of(const Frame& frame, const SeenStrands* strands) {
  const int zoom = zoom_of(frame);
  auto picture = paled(frame);
  if (strands != nullptr) tint(picture, *strands);
  Ground ground{enlarged(picture, zoom), enlarged(image::above(mask_of(frame), 127, 255), zoom),
                zoom};
  draw_outline(ground.picture, ground.rope, OverlayStyle(ground.picture.width()));
  return ground;
}

}  // namespace flowdlo::tools
