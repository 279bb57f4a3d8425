#include "field/view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "field/block_map.hpp"
#include "field/channel.hpp"
#include "field/region.hpp"
#include "field/surface.hpp"

namespace flowdlo::field {
namespace {

using Eigen::Vector2f;

constexpr float kTaken = 0.5F;  // of the channel `rope`, from which on a pixel is taken for rope

// Pixels of the region, in which a rope is 8 px wide.
constexpr std::array kBeside_px{-2.0F, -1.0F, 0.0F, 1.0F, 2.0F};  // a drawn curve lies off the axis
constexpr int kTipFrom_px = -2;                                   // a tip lies ahead of a line's
constexpr int kTipTo_px = 7;                                      // end, which is cut where it
constexpr int kTipBeside_px = 3;                                  // bends to another strand

// [0, 1] how much `along` is the direction with the cosine and sine of twice its angle: 0 from 45
// degrees on.
float sameness(float cosine, float sine, const Vector2f& along) {
  const float length = std::sqrt(cosine * cosine + sine * sine);
  if (length < 1e-3F) return 0;
  const float twice = along.x() * along.x() - along.y() * along.y();
  return std::max(0.0F, (cosine * twice + sine * 2 * along.x() * along.y()) / length);
}

}  // namespace

FieldView::FieldView(const StrandField& seen)
    : channels_(seen.channels),
      scale_(seen.region.scale),
      origin_(seen.region.to_region(Vector2f(0, 0))) {}

FieldView FieldView::from_copy(const Vector2f& origin, float scale) const {
  FieldView view = *this;
  view.scale_ = scale_ / scale;
  view.origin_ = origin_ - view.scale_.cwiseProduct(origin);
  return view;
}

FieldView::Shown FieldView::shown(const Vector2f& p, const Vector2f& along) const {
  const Surface surface(channels_);
  const Vector2f middle = to_region(p);
  const Vector2f across(-along.y(), along.x());
  Shown most;
  for (const float beside : kBeside_px) {
    const Surface::Spot spot = surface.spot(middle + beside * across);
    const float top = spot.at(kCentre);
    if (top > most.top) {
      most.top = std::max(most.top, top * sameness(spot.at(kCos), spot.at(kSin), along));
    }
    const float below = spot.at(kUnder);
    if (below > most.below) {
      most.below =
          std::max(most.below, below * sameness(spot.at(kUnderCos), spot.at(kUnderSin), along));
    }
  }
  return {std::min(1.0F, most.top), std::min(1.0F, most.below)};
}

float FieldView::at(const Vector2f& p, Channel channel) const {
  return Surface(channels_).at(to_region(p), channel);
}

float FieldView::width_px(const Vector2f& p) const {
  const Surface::Spot spot = Surface(channels_).spot(to_region(p));
  if (spot.at(kRope) < kTaken) return 0;
  return kRope_px * std::exp2(spot.at(kWidth)) / (0.5F * (scale_.x() + scale_.y()));
}

bool FieldView::is_rope(const Vector2f& p) const { return at(p, kRope) > kTaken; }

std::vector<std::uint8_t> FieldView::rope_mask(int width, int height) const {
  std::vector<std::uint8_t> mask(static_cast<std::size_t>(width) * height, 0);
  if (channels_.empty()) return mask;
  // Of a block that begins at pixel `first` of the region: where the frame's pixels in it begin.
  const auto begin = [this](int first, int axis, int most) {
    const float at = (static_cast<float>(first) - 0.5F - origin_[axis]) / scale_[axis];
    return static_cast<int>(std::clamp(std::ceil(at), 0.0F, static_cast<float>(most)));
  };
  for (const image::Point& block : channels_.map()->blocks) {
    const image::Rect part = pixels_of(block);
    const int last_v = begin(part.y + part.height, 1, height);
    const int last_u = begin(part.x + part.width, 0, width);
    for (int v = begin(part.y, 1, height); v < last_v; ++v) {
      for (int u = begin(part.x, 0, width); u < last_u; ++u) {
        if (!is_rope({static_cast<float>(u), static_cast<float>(v)})) continue;
        mask[static_cast<std::size_t>(v) * width + u] = 255;
      }
    }
  }
  return mask;
}

float FieldView::tip_ahead(const Vector2f& p, const Vector2f& outward) const {
  const Surface surface(channels_);
  const Vector2f at = to_region(p);
  const Vector2f across(-outward.y(), outward.x());
  float most = 0;
  for (int ahead = kTipFrom_px; ahead <= kTipTo_px; ++ahead) {
    for (int beside = -kTipBeside_px; beside <= kTipBeside_px; ++beside) {
      const Vector2f q =
          at + static_cast<float>(ahead) * outward + static_cast<float>(beside) * across;
      most = std::max(most, surface.at(q, kTip));
    }
  }
  return std::min(1.0F, most);
}

}  // namespace flowdlo::field
