#include "path/cover.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "geometry/depth.hpp"
#include "geometry/pixel.hpp"

namespace flowdlo::path {
namespace {

using Eigen::Vector2f;

constexpr float kMarginNoise_m = 0.003F;  // nearer or farther than the rope by this
constexpr float kMarginRadii = 0.5F;      // and this many radii of it
constexpr float kBelow_m = 0.03F;         // another strand this far below is background
constexpr int kProbes = 4;                // behind the mask's edge, a pixel and a half apart
constexpr float kProbeStepPx = 1.5F;

}  // namespace

Cover::Cover(const Region& region, const Frame& frame, float width_px, const field::FieldView* seen)
    : region_(region), frame_(frame), width_px_(width_px), seen_(seen) {}

field::FieldView::Shown Cover::shown(const Vector2f& p, const Vector2f& along) const {
  if (seen_ == nullptr) return {};
  return seen_->shown(p + offset_of(region_), along);
}

bool Cover::masked(const Vector2f& p) const { return lit(region_.mask, p); }

bool Cover::near_mask(const Vector2f& p) const {
  for (const int dv : {-1, 0, 1}) {
    for (const int du : {-1, 0, 1}) {
      if (masked(p + Vector2f(static_cast<float>(du), static_cast<float>(dv)))) return true;
    }
  }
  return false;
}

float Cover::depth_around(const Vector2f& p, bool on_mask) const {
  std::array<float, 5> values{};
  std::size_t count = 0;
  const auto u = geometry::nearest_px(p.x());
  const auto v = geometry::nearest_px(p.y());
  for (const auto& [du, dv] : {std::pair{0, 0}, {1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
    const int image_u = u + du + region_.offset_px.x;
    const int image_v = v + dv + region_.offset_px.y;
    if (image_u < 0 || image_v < 0 || image_u >= frame_.width || image_v >= frame_.height) continue;
    const float z = frame_.depth_m[static_cast<std::size_t>(image_v) * frame_.width + image_u];
    if (lit(region_.mask, u + du, v + dv) != on_mask || !geometry::measured(z)) continue;
    values[count++] = z;
  }
  if (count == 0) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(count / 2);
  std::nth_element(values.begin(), middle, values.begin() + static_cast<std::ptrdiff_t>(count));
  return *middle;
}

float Cover::rope_depth(const Vector2f& p) const { return depth_around(p, true); }

float Cover::margin_m(float rope_m) const {
  const float radius_m = 0.5F * width_px_ * rope_m / std::max(1.0F, frame_.intrinsics.fx);
  return kMarginNoise_m + kMarginRadii * radius_m;
}

bool Cover::other_rope(const Vector2f& p) const {
  if (frame_.instances.empty() || masked(p)) return false;
  const int u = geometry::nearest_px(p.x()) + region_.offset_px.x;
  const int v = geometry::nearest_px(p.y()) + region_.offset_px.y;
  if (u < 0 || v < 0 || u >= frame_.width || v >= frame_.height) return false;
  return frame_.instances[static_cast<std::size_t>(v) * frame_.width + u] != 0;
}

Sight Cover::at(const Vector2f& p, float rope_m) const {
  if (other_rope(p)) return Sight::kHidden;
  if (rope_m <= 0) return Sight::kUnknown;
  const float z = depth_around(p, false);
  if (z <= 0) return Sight::kUnknown;
  const float margin = margin_m(rope_m);
  if (z < rope_m - margin) return Sight::kHidden;
  return z > rope_m + margin ? Sight::kOpen : Sight::kUnknown;
}

bool Cover::open(const Vector2f& p, float rope_m) const {
  return masked(p) ? rope_depth(p) > rope_m + kBelow_m : at(p, rope_m) == Sight::kOpen;
}

Sight Cover::beyond(Vector2f p, const Vector2f& direction, float rope_m, float reach_px) const {
  float walked = 0;
  for (; masked(p); ++walked) {
    if (walked > reach_px) return Sight::kUnknown;
    p += direction;
  }
  const Vector2f edge = p;
  int hidden = 0;
  int open = 0;
  for (int i = 0; i < kProbes; ++i) {
    p += kProbeStepPx * direction;
    if (masked(p)) break;
    const Sight sight = at(p, rope_m);
    hidden += sight == Sight::kHidden ? 1 : 0;
    open += sight == Sight::kOpen ? 1 : 0;
  }
  if (2 * hidden > kProbes) {
    return rises_to(edge, direction, rope_m) ? Sight::kUnknown : Sight::kHidden;
  }
  return 2 * open > kProbes ? Sight::kOpen : Sight::kUnknown;
}

bool Cover::meets(Vector2f p, const Vector2f& direction, float reach_px) const {
  for (float walked = 0; masked(p); ++walked) {
    if (walked > reach_px) return true;
    p += direction;
  }
  for (int i = 0; i < kProbes; ++i) {
    p += kProbeStepPx * direction;
    if (masked(p)) return true;
  }
  return false;
}

// Whether what shows beyond `edge` is nearer than the rope only farther on: a table seen aslant,
// on which the rope lies. Another rope's label hides whatever the depth says.
bool Cover::rises_to(const Vector2f& edge, const Vector2f& direction, float rope_m) const {
  if (other_rope(edge + kProbeStepPx * direction)) return false;
  const float near = depth_around(edge + kProbeStepPx * direction, false);
  const float far = depth_around(edge + kProbes * kProbeStepPx * direction, false);
  if (near <= 0 || far <= 0) return false;
  const float at_edge_m = near + (near - far) / (kProbes - 1);
  return at_edge_m >= rope_m - margin_m(rope_m);
}

}  // namespace flowdlo::path
