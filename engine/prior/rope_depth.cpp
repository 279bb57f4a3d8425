// A depth z read at a pixel t radii beside the axis lies on a round tube's near surface: the axis
// is r sqrt(1 - t^2) deeper along the ray, or 1 / sin(ray, axis) times that where the rope runs
// towards the camera. Every reading thus claims a depth of the axis, and the profile is fitted to
// the claims: first to those only one strand can have made, then, where strands share pixels, each
// reading goes to the strand whose surface it fits better.
#include "prior/rope_depth.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "geometry/quantile.hpp"
#include "prior/depth_profile.hpp"
#include "prior/ground.hpp"
#include "prior/rope_radius.hpp"

namespace flowdlo::prior {
namespace {

constexpr float kCore = 0.8F;          // radii: what lies farther out is rim
constexpr float kRimPx = 0.8F;         // and so are pixels this near to the mask's edge
constexpr float kRimWidthPx = 5.0F;    // of ropes at least this wide
constexpr float kSmoothWidths = 0.5F;  // see ProfileConfig
constexpr float kLeastSmoothPx = 4.5F;
constexpr float kTensionSmooths = 12.0F;
constexpr double kLeastDepth_m = 1e-3;
constexpr float kLeastSine = 0.25F;  // of ray and axis
constexpr float kForgiven = 0.5F;    // radii of misfit
constexpr int kSlantRounds = 2;      // a steeper axis lies deeper, and is steeper for it
constexpr float kSameSlant = 0.03F;

class Measurement {
 public:
  Measurement(const Strip& strip, const Extent& extent) : strip_(strip), extent_(extent) {}

  RopeDepth run() {
    RopeDepth rope;
    if (strip_.readings.empty()) return rope;
    background_m_ = background_m(strip_);
    radius_m_ = mask_radius_m(strip_, extent_, background_m_);
    slant_.assign(strip_.stations.size(), 1.0F);
    collect();
    fit(false);
    incline();
    radius_m_ = depth_radius_m(strip_, extent_, axis_m_, slant_, radius_m_);
    collect();
    fit(true);
    for (int round = 0; round < kSlantRounds && incline() > kSameSlant; ++round) fit(true);
    rope.axis_m = axis_m_;
    rope.slant = slant_;
    rope.radius_m = radius_m_;
    describe(rope);
    const std::vector<double> deep_m = too_deep_m(strip_, axis_m_, radius_m_);
    for (std::size_t i = 0; i < deep_m.size(); ++i) {
      rope.axis_m[i] = std::max(kLeastDepth_m, rope.axis_m[i] - deep_m[i]);
    }
    return rope;
  }

 private:
  [[nodiscard]] const Station& station(int i) const {
    return strip_.stations[static_cast<std::size_t>(i)];
  }

  /// Readings away from the rim and from the rope's caps.
  void collect() {
    core_.clear();
    for (const Reading& reading : strip_.readings) {
      const Station& at = station(reading.station);
      if (!extent_.holds(at)) continue;
      if (reading.depth_m > background_m_[static_cast<std::size_t>(reading.station)]) continue;
      if (std::abs(reading.offset_px) * at.aside * reading.depth_m > kCore * radius_m_) continue;
      const float edge = std::min(at.left_px + reading.offset_px, at.right_px - reading.offset_px);
      if (strip_.width_px >= kRimWidthPx && edge < kRimPx) continue;
      core_.push_back(reading);
    }
    if (core_.empty()) core_ = strip_.readings;  // few and far out: better than none
  }

  /// How much deeper than the surface the axis is, `offset_px` beside it.
  [[nodiscard]] float push_m(int i, float offset_px, float depth_m) const {
    const Station& at = station(i);
    const float t = offset_px * at.aside * depth_m / radius_m_;
    const float height = std::sqrt(std::max(0.05F, 1 - t * t));
    return radius_m_ * height * slant_[static_cast<std::size_t>(i)] / at.ray.norm();
  }

  /// True when the reading fits its own strand better than the rival's.
  [[nodiscard]] bool own(const Reading& reading) const {
    const auto misfit = [&](int i, float offset_px) {
      const auto axis = static_cast<float>(axis_m_[static_cast<std::size_t>(i)]);
      return std::abs(reading.depth_m + push_m(i, offset_px, reading.depth_m) - axis);
    };
    return misfit(reading.station, reading.offset_px) <
           misfit(reading.rival, reading.rival_offset_px);
  }

  void fit(bool shared) {
    std::vector<DepthClaim> claims;
    claims.reserve(core_.size());
    for (const Reading& reading : core_) {
      if (reading.rival >= 0 && !(shared && own(reading))) continue;
      claims.push_back(
          {reading.station,
           reading.depth_m + push_m(reading.station, reading.offset_px, reading.depth_m), 1});
    }
    if (claims.empty()) {  // strands side by side all along
      for (const Reading& reading : core_) {
        claims.push_back(
            {reading.station,
             reading.depth_m + push_m(reading.station, reading.offset_px, reading.depth_m), 1});
      }
    }
    const float smooth_px = std::max(kSmoothWidths * strip_.width_px, kLeastSmoothPx);
    const float smooth = smooth_px / std::max(strip_.step_px, 1e-3F);
    axis_m_ = fit_profile(static_cast<int>(strip_.stations.size()), claims, axis_m_,
                          {.smoothing_stations = smooth,
                           .tension_stations = kTensionSmooths * smooth,
                           .claims_per_station = kCore * std::min(strip_.width_px, 10.0F),
                           .noise_m = kForgiven * radius_m_,
                           .slant = slant_});
    for (double& z : axis_m_) z = std::max(z, kLeastDepth_m);  // where it goes on beyond all depths
  }

  /// 1 / sin of the angle between the ray and the axis. Returns by how much it changed at most, as
  /// a share.
  float incline() {
    float most = 0;
    const int last = static_cast<int>(strip_.stations.size()) - 1;
    const int reach =
        std::max(1, static_cast<int>(strip_.width_px / std::max(strip_.step_px, 1e-3F)));
    for (int i = 0; i <= last; ++i) {
      const int a = std::max(0, i - reach);
      const int b = std::min(last, i + reach);
      const Eigen::Vector3f along =
          station(b).ray * static_cast<float>(axis_m_[static_cast<std::size_t>(b)]) -
          station(a).ray * static_cast<float>(axis_m_[static_cast<std::size_t>(a)]);
      const float length = along.norm();
      if (!(length > 0)) continue;
      const float sine = along.cross(station(i).ray).norm() / (length * station(i).ray.norm());
      float& slant = slant_[static_cast<std::size_t>(i)];
      const float before = std::exchange(slant, 1 / std::max(sine, kLeastSine));
      most = std::max(most, std::abs(slant / before - 1));
    }
    return most;
  }

  void describe(RopeDepth& rope) const {
    std::vector<int> backing(strip_.stations.size(), 0);
    std::vector<float> misfits;
    for (const Reading& reading : core_) {
      int& backs = backing[static_cast<std::size_t>(reading.station)];
      if (reading.rival >= 0 && !own(reading)) {
        --backs;
        continue;
      }
      const float claim =
          reading.depth_m + push_m(reading.station, reading.offset_px, reading.depth_m);
      const auto i = static_cast<std::size_t>(reading.station);
      const float misfit = std::abs(claim - static_cast<float>(axis_m_[i])) / slant_[i];
      misfits.push_back(misfit);
      backs += misfit < radius_m_ ? 1 : 0;
    }
    for (const int backs : backing) rope.seen.push_back(backs > 0 ? 1 : 0);
    rope.noise_m = misfits.empty() ? radius_m_ : 1.4826F * geometry::median_of(misfits);
  }

  const Strip& strip_;
  const Extent& extent_;
  std::vector<Reading> core_;
  std::vector<float> background_m_;
  std::vector<float> slant_;
  std::vector<double> axis_m_;
  float radius_m_ = 0;
};

}  // namespace

RopeDepth measure_rope(const Strip& strip, const Extent& extent) {
  return Measurement(strip, extent).run();
}

}  // namespace flowdlo::prior
