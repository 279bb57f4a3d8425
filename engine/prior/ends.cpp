#include "prior/ends.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "geometry/polyline.hpp"
#include "geometry/quantile.hpp"

namespace flowdlo::prior {
namespace {

using Eigen::Vector2f;

constexpr float kOwnWidths = 3.0F;        // of path that belong to an end
constexpr float kAloneWidths = 1.3F;      // other strands are farther from a tip of its own
constexpr float kCutWidths = 1.0F;        // drawn anew
constexpr float kSameTipWidths = 0.8F;    // between the path's tip and the one drawn anew
constexpr float kFollowWidths = 3.0F;     // of mask beyond the path, at most
constexpr float kDirectionWidths = 0.7F;  // length over which the direction is taken
constexpr float kMiddleWidths = 0.8F;     // the mask's edge is looked for this far
constexpr float kProbePx = 0.5F;
constexpr float kGain = 0.5F;           // of the way to the middle, a step
constexpr float kCoveredWidths = 0.7F;  // mask this near to another part of the path is passed
constexpr float kMostShare = 0.25F;     // of the strip that a cap may take
constexpr float kFreePx = 2.5F;         // beyond a tip there is no mask
constexpr float kNearerWidths = 2.0F;   // nearer than the rope: something before it
constexpr float kInnerWidths = 15.0F;
constexpr float kEatenWidths = 0.5F;
constexpr float kHangsWidths = 5.0F;  // before what lies farther
constexpr float kHeldWidths = 0.5F;   // behind the rope, at most: what holds it
constexpr float kSteepestTip = 2.0F;  // widths of depth a width towards the tip
constexpr int kMostlyNothing = 3;     // times as much of the rope without a depth beside it
constexpr float kEdgePx = 0.25F;      // how far both edges together lie beyond what was probed
constexpr float kWidthFrom = 1.0F;    // widths from a tip between which the local width
constexpr float kWidthTo = 3.0F;      // is measured
constexpr float kTipPx = 1.0F;        // what lies nearer to the tip is uncertain
constexpr float kTipShare = 0.6F;     // of half a width: so much of a cap tells its shape
constexpr float kTellingPx = 5.5F;    // caps of thinner ropes tell nothing
// Caps are taken for round below the first mean fill, for square above the second, and for
// something between them in between; the finer the mask, the nearer to what geometry says.
constexpr float kCoarseRound = 0.90F;
constexpr float kCoarseSquare = 0.96F;
constexpr float kFineRound = 0.84F;
constexpr float kFineSquare = 0.92F;
constexpr float kFinePx = 10.0F;
constexpr float kUnknownCap = 0.5F;  // of half a width: off by a quarter at most, round or square
// Radii of deviation: of a fine mask's round tips, of its others, and of those of coarse masks.
constexpr float kRoundDoubt = 0.12F;
constexpr float kFineDoubt = 0.36F;
constexpr float kCoarseDoubt = 0.42F;
constexpr float kSurelyRound = 0.9F;

std::size_t pixel(const Frame& frame, const Vector2f& p) {
  return static_cast<std::size_t>(std::floor(p.y() + 0.5F)) * frame.width +
         static_cast<std::size_t>(std::floor(p.x() + 0.5F));
}

bool inside(const Frame& frame, const Vector2f& p) {
  return p.x() >= 0 && p.y() >= 0 && p.x() <= static_cast<float>(frame.width - 1) &&
         p.y() <= static_cast<float>(frame.height - 1);
}

bool masked(const Frame& frame, const Vector2f& p) {
  return inside(frame, p) && frame.mask[pixel(frame, p)] > 127;
}

/// Unit direction in which the back of `points` looks out.
Vector2f outward(const std::vector<Vector2f>& points, float reach_px) {
  for (std::size_t i = points.size(); i-- > 0;) {
    const Vector2f d = points.back() - points[i];
    if (d.norm() >= reach_px) return d.normalized();
  }
  const Vector2f whole = points.back() - points.front();
  return whole.norm() > 0 ? Vector2f(whole.normalized()) : Vector2f(0, 0);
}

/// True where the path, but for its last `own_px`, has passed within `covered_px` of `p`.
bool passed(const std::vector<Vector2f>& points, const Vector2f& p, float own_px,
            float covered_px) {
  float walked = 0;
  for (std::size_t i = points.size() - 1; i-- > 0;) {
    walked += (points[i] - points[i + 1]).norm();
    if (walked > own_px && (points[i] - p).norm() < covered_px) return true;
  }
  return false;
}

/// How far the middle of the mask lies from `p` along `normal`; 0 where it has no edge near.
float off_middle(const Frame& frame, const Vector2f& p, const Vector2f& normal, float most_px) {
  std::array<float, 2> reach_px{0, 0};
  for (const std::size_t side : {0U, 1U}) {
    const Vector2f across = side == 0 ? Vector2f(-normal) : normal;
    while (masked(frame, p + (reach_px[side] + kProbePx) * across)) {
      reach_px[side] += kProbePx;
      if (reach_px[side] > most_px) return 0;
    }
  }
  return 0.5F * (reach_px[1] - reach_px[0]);
}

/// Follows the middle of the mask beyond the back of `points`.
void follow(std::vector<Vector2f>& points, float width_px, const Frame& frame) {
  const float covered = kCoveredWidths * width_px;
  for (int step = 0; static_cast<float>(step) <= kFollowWidths * width_px; ++step) {
    const Vector2f direction = outward(points, std::max(2.0F, kDirectionWidths * width_px));
    if (direction.norm() <= 0) return;
    const Vector2f ahead = points.back() + direction;
    if (!masked(frame, ahead)) {
      for (const float part : {0.5F, 0.25F}) {
        const Vector2f p = points.back() + part * direction;
        if (masked(frame, p)) points.push_back(p);
      }
      return;
    }
    if (passed(points, ahead, 2 * covered + static_cast<float>(step), covered)) return;
    const Vector2f normal{-direction.y(), direction.x()};
    const float off = off_middle(frame, ahead, normal, kMiddleWidths * width_px);
    points.push_back(ahead + std::clamp(kGain * off, -0.5F, 0.5F) * normal);
  }
}

/// The last width before a tip is only a guess where the rope bends: drawn anew. Nothing when the
/// path's end is no tip of its own, or when the new one leads elsewhere.
std::vector<Vector2f> redrawn(const std::vector<Vector2f>& points, float width_px,
                              const Frame& frame) {
  const Vector2f out = outward(points, width_px);
  const bool tip = !masked(frame, points.back() + kFreePx * out);
  const float own = kOwnWidths * width_px;
  if (!tip || geometry::cumulative_length(points).back() < 2 * own ||
      passed(points, points.back(), own, kAloneWidths * width_px)) {
    return {};
  }
  std::vector<Vector2f> result = points;
  while (result.size() > 2 && (result.back() - points.back()).norm() < kCutWidths * width_px) {
    result.pop_back();
  }
  follow(result, width_px, frame);
  if ((result.back() - points.back()).norm() > kSameTipWidths * width_px) return {};
  return result;
}

/// One end of the strip, seen from there inwards.
class StripEnd {
 public:
  StripEnd(const Strip& strip, bool front) : strip_(strip), front_(front) {}

  /// True where the mask ends, and not because something nearer than the rope begins.
  [[nodiscard]] bool free(const Frame& frame) const {
    const Vector2f inward{at(0).normal.y(), -at(0).normal.x()};
    const Vector2f out = front_ ? Vector2f(-inward) : inward;
    bool edge = false;
    for (float step = kProbePx; step <= kFreePx; step += kProbePx) {
      const Vector2f p = at(0).point_px + step * out;
      if (!inside(frame, p)) return false;
      edge = edge || !masked(frame, p);
    }
    return edge && !covered(frame, out);
  }

  /// Half the mask's width, from stations a little inside; half of `usual_px` without any.
  [[nodiscard]] float half_px(float usual_px) const {
    std::vector<float> widths;
    for (int i = 0; i < count() && reach(i) < kWidthTo * usual_px; ++i) {
      if (reach(i) < kWidthFrom * usual_px || !at(i).bounded || near(i)) continue;
      widths.push_back(at(i).left_px + at(i).right_px + kEdgePx);
    }
    if (static_cast<float>(widths.size()) * strip_.step_px < 0.5F * usual_px) {
      return 0.5F * usual_px;
    }
    return 0.5F * geometry::median_of(widths);
  }

  /// How wide the cap is next to its tip, as a share of the rope: a round one 0.76, a square one 1.
  /// Negative where another strand is near.
  [[nodiscard]] float fill(float half_px) const {
    float filled = 0;
    int stations = 0;
    for (int i = 0; i < count() && reach(i) < std::max(kTipShare * half_px, kTipPx + 1); ++i) {
      const Station& station = at(i);
      if (near(i)) return -1;
      if (reach(i) < kTipPx) continue;
      ++stations;
      if (!station.masked) continue;
      filled += std::min((station.left_px + station.right_px + kEdgePx) / (2 * half_px), 1.0F);
    }
    return stations > 0 ? filled / static_cast<float>(stations) : -1;
  }

 private:
  /// What the readings near the tip say.
  struct Tip {
    float depth_m = 0;   // 0: none
    float slope_m = 0;   // depth a width towards the tip
    bool hangs = false;  // before something farther, or before nothing that is measured
  };

  [[nodiscard]] Tip tip() const {
    std::vector<float> first;
    std::vector<float> next;
    std::array<std::vector<float>, 2> heights;  // and farther in, clear of what covers the tip
    int beside = 0;
    int before_nothing = 0;
    for (const Reading& reading : strip_.readings) {
      const Station& station = strip_.stations[static_cast<std::size_t>(reading.station)];
      const float in = std::abs(station.arclength_px - at(0).arclength_px) / strip_.width_px;
      if (in < kWidthTo) (in < kWidthFrom ? first : next).push_back(reading.depth_m);
      if (in > kInnerWidths) continue;
      const bool tells = station.beside_m > reading.depth_m;  // something nearer hides what does
      if (in >= kWidthTo) ++(tells ? beside : before_nothing);
      if (!tells) continue;
      heights[in < kWidthTo ? 0 : 1].push_back(station.beside_m - reading.depth_m);
    }
    if (first.empty()) return {};
    Tip tip;
    tip.depth_m = geometry::median_of(first);
    const float width_m = tip.depth_m * strip_.width_px * at(0).aside;
    if (!next.empty()) {
      const float apart = 0.5F * kWidthTo;  // widths between the middles of both parts
      tip.slope_m = (tip.depth_m - geometry::median_of(next)) / apart;
      tip.slope_m = std::clamp(tip.slope_m, -kSteepestTip * width_m, kSteepestTip * width_m);
    }
    float height_m = 0;
    for (std::vector<float>& some : heights) {
      if (!some.empty() && height_m <= kHangsWidths * width_m) height_m = geometry::median_of(some);
    }
    tip.hangs = height_m > kHangsWidths * width_m || before_nothing > kMostlyNothing * beside;
    return tip;
  }

  /// Whether what lies beyond is nearer than the rope by two widths, or about as far as a rope that
  /// hangs: a gripper holds it.
  [[nodiscard]] bool covered(const Frame& frame, const Vector2f& out) const {
    const Tip rope = tip();
    if (rope.depth_m <= 0) return false;
    const float width_m = rope.depth_m * strip_.width_px * at(0).aside;
    const bool hangs = rope.hangs;
    const float covering_m =
        hangs ? rope.depth_m + std::max(rope.slope_m, 0.0F) + kHeldWidths * width_m
              : rope.depth_m - kNearerWidths * width_m;
    // A frayed mask ends before the rope does: what holds it goes on beyond the rest.
    const float from_px = hangs ? kFreePx + kEatenWidths * strip_.width_px : kFreePx;
    int nearer = 0;
    for (const float step : {0.0F, 1.5F, 3.0F}) {
      const Vector2f p = at(0).point_px + (from_px + step) * out;
      if (!inside(frame, p) || (hangs && masked(frame, p))) continue;  // a strand holds nothing
      const float beyond_m = frame.depth_m[pixel(frame, p)];
      nearer += beyond_m > 1e-6F && beyond_m < covering_m ? 1 : 0;
    }
    return nearer >= 2;
  }
  [[nodiscard]] int count() const { return static_cast<int>(strip_.stations.size()); }
  [[nodiscard]] std::size_t index(int i) const {
    return static_cast<std::size_t>(front_ ? i : count() - 1 - i);
  }
  [[nodiscard]] const Station& at(int i) const { return strip_.stations[index(i)]; }
  [[nodiscard]] bool near(int i) const { return strip_.neighbour[index(i)] >= 0; }
  [[nodiscard]] float reach(int i) const { return static_cast<float>(i) * strip_.step_px; }

  const Strip& strip_;
  bool front_;
};

/// In [0, 1]: how much of half a width a cap of that mean fill reaches beyond the centerline.
float roundness(float fill, float width_px) {
  const bool fine = width_px >= kFinePx;
  const float round = fine ? kFineRound : kCoarseRound;
  const float square = fine ? kFineSquare : kCoarseSquare;
  return std::clamp((square - fill) / (square - round), 0.0F, 1.0F);
}

}  // namespace

std::vector<Vector2f> to_the_tips(std::span<const Vector2f> path_px, float width_px,
                                  const Frame& frame) {
  std::vector<Vector2f> points(path_px.begin(), path_px.end());
  for (int side = 0; side < 2; ++side) {
    std::reverse(points.begin(), points.end());
    std::vector<Vector2f> again = redrawn(points, width_px, frame);
    if (!again.empty()) points = std::move(again);
    follow(points, width_px, frame);
  }
  return points;
}

Extent without_caps(const Strip& strip, const Frame& frame) {
  const float whole = static_cast<float>(strip.stations.size() - 1) * strip.step_px;
  std::array<float, 2> half_px{0, 0};
  std::array<bool, 2> tip{};
  float fill = 0;
  float width_px = 0;
  int told = 0;
  for (const std::size_t side : {0U, 1U}) {
    const StripEnd end(strip, side == 0);
    tip[side] = end.free(frame);
    if (!tip[side]) continue;
    half_px[side] = end.half_px(strip.width_px);
    const float filled = end.fill(half_px[side]);
    if (filled < 0 || 2 * half_px[side] < kTellingPx) continue;
    fill += filled;
    width_px += 2 * half_px[side];
    ++told;
  }
  // A rope's ends are alike: where one tells nothing, the other speaks for both.
  const float count = static_cast<float>(told);
  const float round = told > 0 ? roundness(fill / count, width_px / count) : kUnknownCap;
  std::array<float, 2> cap_px{0, 0};
  for (const std::size_t side : {0U, 1U}) {
    if (!tip[side]) continue;
    cap_px[side] = round * std::clamp(half_px[side] - 0.5F * kEdgePx, 0.0F, kMostShare * whole);
  }
  const bool fine = told > 0 && width_px / count >= kFinePx;
  const float doubt = round > kSurelyRound ? kRoundDoubt : kFineDoubt;
  return {cap_px[0], whole - cap_px[1], tip, fine ? doubt : kCoarseDoubt};
}

}  // namespace flowdlo::prior
