#include "field/region.hpp"

#include <algorithm>
#include <cmath>

namespace flowdlo::field {
namespace {

constexpr int kLeastSide_px = 16;

}  // namespace

Eigen::Vector2f Region::to_region(const Eigen::Vector2f& frame_px) const {
  const Eigen::Vector2f corner(static_cast<float>(box.x), static_cast<float>(box.y));
  return ((frame_px - corner).array() + 0.5F) * scale.array() - 0.5F;
}

Eigen::Vector2f Region::to_frame(const Eigen::Vector2f& region_px) const {
  const Eigen::Vector2f corner(static_cast<float>(box.x), static_cast<float>(box.y));
  return ((region_px.array() + 0.5F) / scale.array() - 0.5F).matrix() + corner;
}

float Region::magnified_for_px() const { return kRope_px / std::sqrt(scale.x() * scale.y()); }

Region region_around(const image::Rect& mask_box, const image::Size& frame, float rope_width_px) {
  const int margin = static_cast<int>(std::ceil(kMarginWidths * rope_width_px + kMargin_px));
  Region region;
  region.box = image::grown(mask_box, margin) & image::all_of(frame);
  const float scale = std::min(kRope_px / rope_width_px, kMostScale);
  const auto side = [&](int px) {
    return std::max(kLeastSide_px, static_cast<int>(std::lround(scale * static_cast<float>(px))));
  };
  region.size = {side(region.box.width), side(region.box.height)};
  region.scale = {static_cast<float>(region.size.width) / static_cast<float>(region.box.width),
                  static_cast<float>(region.size.height) / static_cast<float>(region.box.height)};
  return region;
}

}  // namespace flowdlo::field
