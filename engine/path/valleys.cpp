#include "path/valleys.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <vector>

#include "geometry/depth.hpp"
#include "geometry/quantile.hpp"
#include "image/blur.hpp"

namespace flowdlo::path {
namespace {

constexpr float kSmoothWidths = 0.1F;  // sigma of the depths' smoothing
constexpr float kLeastShare = 0.05F;   // of valid depths under it
constexpr float kProbeWidths = 0.3F;   // from a valley to its sides
constexpr int kDirections = 8;
constexpr float kSlope = 0.75F;      // metres of depth a metre sideways; more is a step,
constexpr float kStepWeight = 2.0F;  // which counts against a valley
constexpr float kQuiet = 0.03F;      // noise above this share of the radius is averaged out
constexpr float kAbsent_m = 1e6F;    // stands for a depth that is missing,
constexpr float kSlit_m = 4e6F;      // and for that of a slit: deeper than any side

struct Depths {
  image::Image<float> smooth_m;  // kAbsent_m outside of the mask
  float noise_m = 0;             // of a single depth
  float usual_m = 0;
};

// Depths inside of the mask, 0 where there are none.
image::Image<float> masked_depths(const image::Mask& mask, image::Point offset_px,
                                  const Frame& frame) {
  image::Image<float> depth(mask.size(), 0.0F);
  const int left = std::max(0, -offset_px.x);
  const int right = std::min(mask.width(), frame.width - offset_px.x);
  for (int v = 0; v < mask.height(); ++v) {
    const int image_v = v + offset_px.y;
    if (image_v < 0 || image_v >= frame.height) continue;
    const std::uint8_t* lit = mask.row(v);
    const float* from = frame.depth_m.data() + static_cast<std::size_t>(image_v) * frame.width;
    float* to = depth.row(v);
    for (int u = left; u < right; ++u) {
      const float z = from[u + offset_px.x];
      if (lit[u] != 0 && geometry::measured(z)) to[u] = z;
    }
  }
  return depth;
}

// Noise from second differences, the large ones left out: a slope has none, and a rope's roundness
// next to none. A mean, for depths that come in coarse steps have a median of nothing.
void measure_noise(const image::Image<float>& depth, Depths& depths) {
  constexpr float kKept = 0.75F;
  constexpr float kSigmas = 0.515F * 2.4495F;  // of the mean of those |a - 2 b + c|
  std::vector<float> bends;
  std::vector<float> values;
  for (int v = 0; v < depth.height(); v += 3) {
    const float* row = depth.row(v);
    for (int u = 1; u + 1 < depth.width(); u += 2) {
      if (row[u - 1] <= 0 || row[u] <= 0 || row[u + 1] <= 0) continue;
      bends.push_back(std::abs(row[u - 1] - 2 * row[u] + row[u + 1]));
      values.push_back(row[u]);
    }
  }
  if (values.empty()) return;
  depths.usual_m = geometry::median_of(values);
  const auto kept = static_cast<std::ptrdiff_t>(kKept * static_cast<float>(bends.size()));
  if (kept == 0) return;
  std::nth_element(bends.begin(), bends.begin() + kept, bends.end());
  const float sum = std::accumulate(bends.begin(), bends.begin() + kept, 0.0F);
  depths.noise_m = sum / static_cast<float>(kept) / kSigmas;
}

Depths smooth_depths(const ValleyView& view, float sigma_px, const Frame& frame) {
  Depths depths;
  image::Image<float> depth = masked_depths(view.mask, view.offset_px, frame);
  measure_noise(depth, depths);
  image::Image<float> weight(depth.size());
  for (int v = 0; v < depth.height(); ++v) {
    std::transform(depth.row(v), depth.row(v) + depth.width(), weight.row(v),
                   [](float z) { return z > 0 ? 1.0F : 0.0F; });
  }
  const std::vector<float> taps = image::gaussian(image::taps_of(sigma_px), sigma_px);
  depth = image::blurred(depth, taps, image::Beyond::kMirrored);
  weight = image::blurred(weight, taps, image::Beyond::kMirrored);
  depths.smooth_m = image::Image<float>(view.mask.size(), kAbsent_m);
  for (int v = 0; v < view.mask.height(); ++v) {
    const std::uint8_t* lit = view.mask.row(v);
    const std::uint8_t* slit = view.closed.row(v);
    const float* sum = depth.row(v);
    const float* share = weight.row(v);
    float* to = depths.smooth_m.row(v);
    for (int u = 0; u < view.mask.width(); ++u) {
      if (lit[u] != 0 && share[u] > kLeastShare) to[u] = sum[u] / share[u];
      if (lit[u] == 0 && slit[u] != 0) to[u] = kSlit_m;
    }
  }
  return depths;
}

// How valleys are looked for: how far away their sides are, how much higher one of them may be, and
// over how many places along the valley the depth is averaged, `stride_px` apart.
struct Probe {
  float reach_px = 2;
  float slope_m = 0;
  int places = 1;  // odd
  float stride_px = 1;
};

image::Point offset(float length_px, double angle) {
  const auto length = static_cast<double>(length_px);
  return {static_cast<int>(std::lround(length * std::cos(angle))),
          static_cast<int>(std::lround(length * std::sin(angle)))};
}

// How much deeper each pixel of `box` is than both sides at +- `side`. Where one side is higher
// than the other by more than a slope explains, there is a step, no valley.
void deeper_than_sides(const image::Image<float>& smooth_m, const image::Rect& box,
                       image::Point side, float slope_m, image::Image<float>& deeper_m) {
  for (int v = box.y; v < box.y + box.height; ++v) {
    const float* here = smooth_m.row(v);
    const float* one = smooth_m.row(v - side.y) - side.x;
    const float* other = smooth_m.row(v + side.y) + side.x;
    float* to = deeper_m.row(v);
    for (int u = box.x; u < box.x + box.width; ++u) {
      const float deeper = here[u] - 0.5F * (one[u] + other[u]);
      const float step = 0.5F * std::abs(one[u] - other[u]) - slope_m;
      const float value = deeper - kStepWeight * std::max(0.0F, step);
      to[u] = here[u] == kAbsent_m ? 0 : std::clamp(value, -slope_m, slope_m);
    }
  }
}

// How much deeper each pixel of `box` is than its sides, in the direction where that is most.
image::Image<float> deepest(const image::Image<float>& smooth_m, const image::Rect& wide,
                            const Probe& probe) {
  const int far = static_cast<int>(std::ceil(probe.reach_px));
  const int along =
      static_cast<int>(std::ceil(probe.stride_px * static_cast<float>(probe.places / 2)));
  const image::Rect whole = image::grown(image::all_of(smooth_m.size()), -far);
  image::Image<float> most(smooth_m.size(), 0.0F);
  image::Image<float> deeper_m(smooth_m.size(), 0.0F);
  const image::Rect outer = image::grown(wide, along) & whole;
  const image::Rect inner = wide & image::grown(image::all_of(smooth_m.size()), -along);
  for (int k = 0; k < kDirections; ++k) {
    const double angle = std::numbers::pi * k / kDirections;
    deeper_than_sides(smooth_m, outer, offset(probe.reach_px, angle), probe.slope_m, deeper_m);
    for (int v = inner.y; v < inner.y + inner.height; ++v) {
      float* to = most.row(v);
      const float* from = deeper_m.row(v);
      if (probe.places == 1) {
        for (int u = inner.x; u < inner.x + inner.width; ++u) to[u] = std::max(to[u], from[u]);
        continue;
      }
      const image::Point near = offset(probe.stride_px, angle + 0.5 * std::numbers::pi);
      const image::Point next = offset(2 * probe.stride_px, angle + 0.5 * std::numbers::pi);
      const float* a = deeper_m.row(v - next.y) - next.x;
      const float* b = deeper_m.row(v - near.y) - near.x;
      const float* c = deeper_m.row(v + near.y) + near.x;
      const float* d = deeper_m.row(v + next.y) + next.x;
      for (int u = inner.x; u < inner.x + inner.width; ++u) {
        to[u] = std::max(to[u], 0.2F * (a[u] + b[u] + from[u] + c[u] + d[u]));
      }
    }
  }
  return most;
}

float sigma_of(float width_px) { return std::clamp(kSmoothWidths * width_px, 0.8F, 4.0F); }

}  // namespace

int valley_margin(float width_px) {
  return static_cast<int>(std::ceil(8 * sigma_of(width_px) + width_px));
}

Valleys measure_valleys(const ValleyView& view, const Frame& frame) {
  const float sigma_px = sigma_of(view.width_px);
  const Depths depths = smooth_depths(view, sigma_px, frame);
  if (depths.usual_m <= 0) return {};
  const float m_per_px = depths.usual_m / std::max(1.0F, frame.intrinsics.fx);
  Valleys valleys;
  valleys.radius_m = 0.5F * view.width_px * m_per_px;
  valleys.noise_m = depths.noise_m / (2 * std::sqrt(std::numbers::pi_v<float>) * sigma_px);
  Probe probe;
  probe.reach_px = std::max(2.0F, kProbeWidths * view.width_px);
  probe.slope_m = kSlope * probe.reach_px * m_per_px;
  if (valleys.noise_m > kQuiet * valleys.radius_m) {
    probe.places = 5;
    probe.stride_px = 2 * sigma_px;
    valleys.noise_m /= std::sqrt(5.0F);
  }
  valleys.depth_m = deepest(depths.smooth_m, view.box, probe);
  for (int v = 0; v < view.mask.height(); ++v) {
    const std::uint8_t* const lit = view.mask.row(v);
    const float* const smooth_m = depths.smooth_m.row(v);
    float* const depth_m = valleys.depth_m.row(v);
    for (int u = 0; u < view.mask.width(); ++u) {
      if (lit[u] == 0 || smooth_m[u] >= kAbsent_m) depth_m[u] = 0;
    }
  }
  return valleys;
}

}  // namespace flowdlo::path
