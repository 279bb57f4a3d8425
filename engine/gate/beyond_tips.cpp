#include "gate/beyond_tips.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/depth.hpp"
#include "geometry/pixel.hpp"

namespace flowdlo::gate {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr std::uint8_t kMaskThreshold = 127;  // 0.5 of an 8-bit mask
constexpr float kBack = 1.5F;                 // widths of curve that give a tip its direction
constexpr float kToTheRim = 2;                // widths from the tip to where the mask ends, at most
constexpr float kClear = 0.75F;               // widths beyond that until the first look
constexpr float kStep = 0.5F;                 // widths from look to look
constexpr float kCore = 0.3F;                 // half of what is taken for the rope, widths
constexpr float kSideFrom = 0.9F;             // what is taken for its sides, widths off the axis
constexpr float kSideTo = 1.5F;
constexpr float kMostAcross = 32;    // depths read across a width
constexpr float kRimFrom = 0.6F;     // just beside the rope: as deep as its sides, so that
constexpr float kRimTo = 0.85F;      // nothing wider passes
constexpr float kMostShift = 0.75F;  // sideways, widths
constexpr float kShiftStep = 0.125F;
constexpr float kSteer = 1.5F;       // radians a width of sideways shift
constexpr double kRise = 0.7;        // radii that a ridge rises above both its sides in the mean,
constexpr double kRiseEither = 0.2;  // and above either,
constexpr double kSure = 3;          // and as many standard errors
constexpr double kDrop = 0.5;        // radii that the rim lies below it,
constexpr double kDropShare = 0.3;   // and this share of the rise,
constexpr double kRimShare = 0.65;   // on this share of its pixels
constexpr double kJump = 1.5;        // radii between its depth and that before it, at most
constexpr int kMisses = 1;           // looks in a row that may fail
constexpr int kLeastSamples = 3;

/// Where one looks, and what is known of the rope there.
struct Look {
  Vector2f px{0, 0};
  Vector2f along{1, 0};  ///< outwards, unit
  float depth_m = 0;     ///< of the rope's surface
};

struct Mean {
  int count = 0;
  double sum = 0;
  double squares = 0;

  explicit Mean(const std::vector<float>& values) : count(static_cast<int>(values.size())) {
    for (const float value : values) {
      sum += static_cast<double>(value);
      squares += static_cast<double>(value) * static_cast<double>(value);
    }
  }
  [[nodiscard]] double mean() const { return sum / count; }
  /// Squared standard error.
  [[nodiscard]] double error2() const {
    return std::max(0.0, squares / count - mean() * mean()) / count;
  }
};

class Outlook {
 public:
  Outlook(const ImageCurve& curve, const Frame& frame) : frame_(frame), curve_(curve) {}

  [[nodiscard]] float widths_beyond(bool at_start) const {
    auto look = first_look(at_start);
    if (!look) return 0;
    float reached = 0;
    int misses = kMisses;  // the rope goes on where the mask ends, or not at all
    for (float beyond = 0; beyond < kFarthestBeyond && misses <= kMisses; beyond += kStep) {
      look->px += kStep * curve_.width_px * look->along;
      if (follow(*look)) {
        reached = beyond + kStep;
        misses = 0;
      } else {
        ++misses;
      }
    }
    return reached;
  }

 private:
  [[nodiscard]] std::optional<std::size_t> pixel(const Vector2f& px) const {
    const int u = geometry::nearest_px(px.x());
    const int v = geometry::nearest_px(px.y());
    if (u < 0 || v < 0 || u >= frame_.width || v >= frame_.height) return std::nullopt;
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(frame_.width) +
           static_cast<std::size_t>(u);
  }
  [[nodiscard]] bool masked(const Vector2f& px) const {
    const auto at = pixel(px);
    return at && frame_.mask[*at] > kMaskThreshold;
  }
  /// 0: none.
  [[nodiscard]] float depth_m(const Vector2f& px) const {
    const auto at = pixel(px);
    if (!at) return 0;
    const float depth = frame_.depth_m[*at];
    return geometry::measured(depth) ? depth : 0;
  }

  /// Just beyond where the mask ends.
  [[nodiscard]] std::optional<Look> first_look(bool at_start) const {
    const auto& points = curve_.points;
    const float length_px = points.back().length_px;
    const float back_px = std::min(kBack * curve_.width_px, 0.5F * length_px);
    const auto inner = std::find_if(points.begin(), points.end(), [&](const CurvePoint& point) {
      return point.length_px >= (at_start ? back_px : length_px - back_px);
    });
    const CurvePoint& tip = at_start ? points.front() : points.back();
    if (inner == points.end() || (tip.px - inner->px).norm() <= 0) return std::nullopt;
    Look look{tip.px, (tip.px - inner->px).normalized(), tip.depth_m - curve_.radius_m};
    const float most = kToTheRim * curve_.width_px + 2;
    float gone = 0;
    while (masked(look.px)) {
      if (gone > most) return std::nullopt;
      look.px += look.along;
      gone += 1;
    }
    look.px += (kClear - kStep) * curve_.width_px * look.along;
    return look;
  }

  /// Moves the look onto the ridge that is there, if one is.
  [[nodiscard]] bool follow(Look& look) const {
    double sum = 0;
    double moment = 0;
    double depth = 0;
    for (float shift = -kMostShift; shift <= kMostShift; shift += kShiftStep) {
      Look moved = look;
      moved.px += shift * curve_.width_px * Vector2f(-look.along.y(), look.along.x());
      const auto ridge = ridge_at(moved);
      if (!ridge) continue;
      sum += ridge->rise_m;
      moment += ridge->rise_m * static_cast<double>(shift);
      depth += ridge->rise_m * ridge->surface_m;
    }
    if (sum <= 0) return false;
    const auto shift = static_cast<float>(moment / sum);
    const Vector2f across(-look.along.y(), look.along.x());
    look.px += shift * curve_.width_px * across;
    look.along = (look.along + kSteer * shift * across).normalized();
    look.depth_m = static_cast<float>(depth / sum);
    return true;
  }

  struct Ridge {
    double surface_m = 0;
    double rise_m = 0;  ///< above both sides in the mean
  };

  /// Depths off the mask between two distances across; negative ones lie right of the direction.
  [[nodiscard]] std::vector<float> depths(const Look& look, float from, float to) const {
    std::vector<float> found;
    const Vector2f across(-look.along.y(), look.along.x());
    const float half_px = std::max(1.0F, 0.5F * kStep * curve_.width_px);
    const float step_px = std::max(1.0F, curve_.width_px / kMostAcross);
    for (float off = from * curve_.width_px; off <= to * curve_.width_px + 1e-3F; off += step_px) {
      for (float on = -half_px; on < half_px; on += step_px) {
        const Vector2f px = look.px + off * across + on * look.along;
        const float depth = masked(px) ? 0 : depth_m(px);
        if (depth > 0) found.push_back(depth);
      }
    }
    return found;
  }

  /// Whether just beside the rope it is deeper than `limit_m`.
  [[nodiscard]] bool drops(const std::vector<float>& rim, double limit_m) const {
    const auto deeper = std::count_if(
        rim.begin(), rim.end(), [&](float depth) { return static_cast<double>(depth) > limit_m; });
    return !rim.empty() &&
           static_cast<double>(deeper) >= kRimShare * static_cast<double>(rim.size());
  }

  /// What rises there as the rope would.
  [[nodiscard]] std::optional<Ridge> ridge_at(const Look& look) const {
    if (masked(look.px)) return std::nullopt;
    const Mean core(depths(look, -kCore, kCore));
    const Mean left(depths(look, kSideFrom, kSideTo));
    const Mean right(depths(look, -kSideTo, -kSideFrom));
    if (std::min({core.count, left.count, right.count}) < kLeastSamples) return std::nullopt;
    const auto radius_m = static_cast<double>(curve_.radius_m);
    const double rise = 0.5 * (left.mean() + right.mean()) - core.mean();
    const double either = std::min(left.mean(), right.mean()) - core.mean();
    const double error = std::sqrt(core.error2() + std::max(left.error2(), right.error2()));
    if (std::abs(core.mean() - static_cast<double>(look.depth_m)) > kJump * radius_m + 3 * error ||
        rise < kRise * radius_m || either < std::max(kRiseEither * radius_m, kSure * error)) {
      return std::nullopt;
    }
    const double limit_m = core.mean() + std::max(kDrop * radius_m, kDropShare * rise);
    if (!drops(depths(look, kRimFrom, kRimTo), limit_m) ||
        !drops(depths(look, -kRimTo, -kRimFrom), limit_m)) {
      return std::nullopt;
    }
    return Ridge{core.mean(), rise};
  }

  const Frame& frame_;
  const ImageCurve& curve_;
};

}  // namespace

float beyond_tips(const ImageCurve& curve, const Frame& frame) {
  const Outlook outlook(curve, frame);
  return std::max(outlook.widths_beyond(true), outlook.widths_beyond(false));
}

}  // namespace flowdlo::gate
