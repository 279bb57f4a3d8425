#include "prior/doubt.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "geometry/camera.hpp"
#include "geometry/quantile.hpp"

namespace flowdlo::prior {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr float kSigmaFloor_m = 0.0003F;
constexpr float kSigmaPixels = 0.25F;
constexpr float kSigmaNoise = 0.2F;  // what smoothing leaves of the depths' noise
// Metres a metre of rope away from the nearest station that is seen.
constexpr float kMaskedGrowth = 0.1F;  // the mask shows where it runs, but not how deep
constexpr float kGapGrowth = 0.25F;
constexpr float kHiddenGrowth = 0.4F;  // under another strand
constexpr float kMostSigma_m = 1.0F;
// Where an end may be: that far from where it seems.
constexpr float kTipPixels = 0.3F;
constexpr float kTipSlant = 0.3F;        // radii more of the cap, towards the camera
constexpr float kTipFray = 1.5F;         // of the deviation of the mask's width
constexpr float kCoveredTip_m = 0.009F;  // the rope goes on under what covers it, or does not
constexpr float kOutsideTip_m = 0.03F;   // it goes on outside of the image
constexpr float kOutsidePx = 3.0F;
constexpr float kGridPx = 0.45F;    // deviation that the pixel grid makes
constexpr float kOfMedian = 1.21F;  // 1.4826 / sqrt(1.5): what three places differ by
// Metres a metre of rope that is not seen is longer or shorter.
constexpr float kMaskedStretch = 0.08F;
constexpr float kGapStretch = 0.15F;

/// What each station's sigma grows by on the way from the nearest one that is seen.
std::vector<float> unseen_growth(std::span<const Vector3f> points, const Strip& strip,
                                 const RopeDepth& rope) {
  std::vector<float> growth(points.size(), kMostSigma_m);
  const auto pass = [&](std::size_t i, std::size_t from) {
    const float open = strip.stations[i].masked ? kMaskedGrowth : kGapGrowth;
    const float rate = strip.neighbour[i] >= 0 ? kHiddenGrowth : open;
    growth[i] = std::min(growth[i], growth[from] + rate * (points[i] - points[from]).norm());
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (rope.seen[i] != 0) growth[i] = 0;
  }
  for (std::size_t i = 1; i < points.size(); ++i) pass(i, i - 1);
  for (std::size_t i = points.size() - 1; i-- > 0;) pass(i, i + 1);
  return growth;
}

/// Of the mask's, from one place to the next, beyond what the pixel grid makes: how frayed it is.
float deviation_of_width_px(const Strip& strip) {
  const auto apart = static_cast<std::size_t>(
      std::max(1.0F, std::round(strip.width_px / std::max(strip.step_px, 1e-3F))));
  const auto clear = [&](std::size_t i) {
    return strip.stations[i].bounded && strip.neighbour[i] < 0;
  };
  const auto wide = [&](std::size_t i) {
    return strip.stations[i].left_px + strip.stations[i].right_px;
  };
  std::vector<float> bends;
  for (std::size_t i = apart; i + apart < strip.stations.size(); ++i) {
    if (!clear(i - apart) || !clear(i) || !clear(i + apart)) continue;
    bends.push_back(std::abs(wide(i) - 0.5F * (wide(i - apart) + wide(i + apart))));
  }
  if (bends.empty()) return 0;
  const float fray = kOfMedian * geometry::median_of(bends);
  return std::sqrt(std::max(0.0F, fray * fray - kGridPx * kGridPx));
}

float tip_doubt_m(const Placed& placed, float fray_px, bool front) {
  const Strip& strip = placed.strip;
  const Station& end = front ? strip.stations.front() : strip.stations.back();
  const double axis_m = front ? placed.rope.axis_m.front() : placed.rope.axis_m.back();
  if (placed.extent.tip[front ? 0 : 1]) {
    const float slant = front ? placed.rope.slant.front() : placed.rope.slant.back();
    const float pixel_m = static_cast<float>(axis_m) * end.aside;
    const float cap = std::hypot(placed.extent.cap_doubt, kTipSlant * (slant - 1));
    return slant * std::hypot(cap * placed.rope.radius_m, kTipPixels * pixel_m,
                              kTipFray * fray_px * pixel_m);
  }
  const Vector2f p = end.point_px;
  const Vector2f last{static_cast<float>(placed.frame.width - 1),
                      static_cast<float>(placed.frame.height - 1)};
  const float inside_px = std::min(p.minCoeff(), (last - p).minCoeff());
  return inside_px < kOutsidePx ? kOutsideTip_m : kCoveredTip_m;
}

/// Stretches not seen, as what their lengths are in doubt by and the node before them.
struct Slack {
  float doubt_m = 0;
  float share = 0;  // of the rope before the stretch's middle
};

std::vector<Slack> slacks(const Placed& placed, std::span<const float> node_arclength_px,
                          const Prior& prior) {
  std::vector<Slack> result;
  bool open = false;
  for (std::size_t i = 0; i + 1 < kNodes; ++i) {
    const float middle_px = 0.5F * (node_arclength_px[i] + node_arclength_px[i + 1]);
    const auto k = std::min(
        static_cast<std::size_t>(std::max(middle_px, 0.0F) / std::max(placed.strip.step_px, 1e-3F)),
        placed.strip.stations.size() - 1);
    const bool seen = placed.rope.seen[k] != 0;
    if (!seen) {
      const float length_m =
          (geometry::to_eigen(prior.nodes[i + 1]) - geometry::to_eigen(prior.nodes[i])).norm();
      if (!open) result.push_back({0, static_cast<float>(i) / (kNodes - 1)});
      result.back().doubt_m +=
          (placed.strip.stations[k].masked ? kMaskedStretch : kGapStretch) * length_m;
    }
    open = !seen;
  }
  return result;
}

}  // namespace

std::vector<float> station_sigma_m(std::span<const Vector3f> points_cam, const Strip& strip,
                                   const RopeDepth& rope, float fx) {
  std::vector<float> sigma_m = unseen_growth(points_cam, strip, rope);
  for (std::size_t i = 0; i < sigma_m.size(); ++i) {
    const float own = kSigmaFloor_m + kSigmaPixels * points_cam[i].z() / fx;
    sigma_m[i] = std::hypot(own, kSigmaNoise * rope.noise_m, sigma_m[i]);
  }
  return sigma_m;
}

void doubt_along(const Placed& placed, std::span<const float> node_arclength_px, Prior& prior) {
  const float fray_px = deviation_of_width_px(placed.strip);
  const float first_m = tip_doubt_m(placed, fray_px, true);
  const float last_m = tip_doubt_m(placed, fray_px, false);
  const std::vector<Slack> stretches = slacks(placed, node_arclength_px, prior);
  for (std::size_t i = 0; i < kNodes; ++i) {
    const float t = static_cast<float>(i) / (kNodes - 1);
    float& sigma_m = prior.sigma_m[i];
    sigma_m = std::hypot(sigma_m, (1 - t) * first_m, t * last_m);
    for (const Slack& slack : stretches) {
      sigma_m = std::hypot(sigma_m, slack.doubt_m * (t < slack.share ? t : 1 - t));
    }
  }
}

}  // namespace flowdlo::prior
