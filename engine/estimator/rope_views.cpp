#include "estimator/rope_views.hpp"

#include <algorithm>
#include <cmath>

#include "geometry/pixel.hpp"

namespace flowdlo::estimator {
namespace {

using Eigen::Vector2f;
using path::Path;

constexpr float kOverOthers = 0.4F;  // share of a bridged stretch that lies on other ropes

std::size_t index_of(const Frame& frame, const Vector2f& p) {
  const int u = std::clamp(geometry::nearest_px(p.x()), 0, frame.width - 1);
  const int v = std::clamp(geometry::nearest_px(p.y()), 0, frame.height - 1);
  return static_cast<std::size_t>(v) * static_cast<std::size_t>(frame.width) +
         static_cast<std::size_t>(u);
}

}  // namespace

RopeView::RopeView(const Parted& parted, std::size_t rope, const Frame& frame)
    : path_(parted.paths.ropes[rope]),
      width_px_(parted.width_px[rope]),
      filtered_(parted.paths.filtered),
      seen_(parted.seen),
      original_(frame),
      mask_(frame.mask.size(), 0),
      depth_m_(frame.depth_m.begin(), frame.depth_m.end()) {
  const auto own = static_cast<std::uint16_t>(rope + 1);
  for (std::size_t p = 0; p < mask_.size(); ++p) mask_[p] = parted.instances[p] == own ? 255 : 0;
  const Path& path = path_;
  const auto on_other = [&](std::size_t sample) {
    const std::uint16_t label = parted.instances[index_of(frame, path.points_px[sample])];
    return label != 0 && label != own;
  };
  // What of the path's width is another rope's, or a slit beside it, is this rope too, unseen.
  const float half_px = 0.5F * parted.width_px[rope];
  const int reach = static_cast<int>(std::ceil(half_px));
  const auto fill = [&](std::size_t sample, bool slits) {
    const Vector2f& at = path.points_px[sample];
    for (int dv = -reach; dv <= reach; ++dv) {
      for (int du = -reach; du <= reach; ++du) {
        if (static_cast<float>(du * du + dv * dv) > half_px * half_px) continue;
        const int u = geometry::nearest_px(at.x()) + du;
        const int v = geometry::nearest_px(at.y()) + dv;
        if (u < 0 || v < 0 || u >= frame.width || v >= frame.height) continue;
        const auto p = static_cast<std::size_t>(v) * static_cast<std::size_t>(frame.width) +
                       static_cast<std::size_t>(u);
        if (mask_[p] != 0 || (parted.instances[p] == 0 && !slits)) continue;
        mask_[p] = 255;
        depth_m_[p] = 0;
      }
    }
  };
  for (std::size_t i = 0; i < path.points_px.size();) {
    std::size_t last = i;
    while (last < path.points_px.size() && path.bridged[last] == path.bridged[i]) ++last;
    std::size_t hidden = 0;
    for (std::size_t k = i; k < last; ++k) hidden += on_other(k) ? 1 : 0;
    const bool bridge = path.bridged[i] != 0;
    const bool slits =
        bridge && static_cast<float>(hidden) >= kOverOthers * static_cast<float>(last - i);
    for (; i < last; ++i) {
      if (slits || on_other(i)) fill(i, slits);
    }
  }
}

Traced RopeView::traced() const {
  Traced traced;
  traced.seen = seen_;
  path::Traversals& result = traced.paths;
  result.ranked.push_back(path_);
  result.ranked.front().width_px = width_px_;
  result.rope_width_px = width_px_;
  result.strands = 1;
  result.filtered = filtered_;
  return traced;
}

Frame RopeView::frame() const {
  Frame view = original_;
  view.mask = mask_;
  view.depth_m = depth_m_;
  view.instances = {};
  return view;
}

}  // namespace flowdlo::estimator
