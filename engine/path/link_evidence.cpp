#include "path/link_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "geometry/segments.hpp"

namespace flowdlo::path {
namespace {

using Eigen::Vector2f;

constexpr float kPi = std::numbers::pi_v<float>;
constexpr float kMost = 3.0F;  // of slopes and curvatures

float angle(const Vector2f& a, const Vector2f& b) {
  return std::acos(std::clamp(a.dot(b), -1.0F, 1.0F)) / kPi;
}

float length_px(int end, const Strands& strands) {
  return static_cast<float>(strands.list[end / 2].points_px.size());
}

// Metres of depth as large as a pixel across.
float metres_per_px(const StrandEnd& a, const StrandEnd& b, const Cover& cover) {
  return 0.5F * (a.depth_m + b.depth_m) / std::max(1.0F, cover.focal_px());
}

}  // namespace

EndFeatures end_features(int end, const Strands& strands, const Cover& cover, float goes_on) {
  const StrandEnd& own = strands.end(end);
  const float w = scale_between(own, own, strands);
  EndFeatures f{};
  f[kEndTip] = own.tip_seen;
  f[kEndHeard] = goes_on;
  f[kEndCut] = own.cut ? 1.0F : 0.0F;
  f[kEndLeaves] = own.leaves ? 1.0F : 0.0F;
  f[kEndLength] = std::log1p(length_px(end, strands) / w);
  f[kEndDeep] = own.depth_m > 0 ? 1.0F : 0.0F;
  f[kEndWidth] = std::log2(w / 8.0F);
  f[kEndSeveral] = strands.several ? 1.0F : 0.0F;
  const auto sight = [&](float widths) {
    const Sight seen = cover.at(own.point_px + widths * w * own.heading, own.depth_m);
    return seen == Sight::kHidden ? 1.0F : seen == Sight::kOpen ? -1.0F : 0.0F;
  };
  f[kEndNear] = sight(1);
  f[kEndMiddle] = sight(2);
  f[kEndFar] = sight(4);
  f[kEndMaskNear] = cover.masked(own.point_px + w * own.heading) ? 1.0F : 0.0F;
  f[kEndMaskMiddle] = cover.masked(own.point_px + 2 * w * own.heading) ? 1.0F : 0.0F;
  return f;
}

SideFeatures side_features(int from, int to, const Strands& strands, const Cover& cover) {
  const StrandEnd& a = strands.end(from);
  const StrandEnd& b = strands.end(to);
  const float w = scale_between(a, b, strands);
  const Vector2f chord = b.point_px - a.point_px;
  const Vector2f way = chord.norm() > 0 ? Vector2f(chord.normalized()) : a.outward;
  const float ahead = a.outward.dot(chord) / w;
  const float aside = geometry::cross(a.outward, chord) / w;
  SideFeatures f{};
  f[kSideTurn] = angle(a.outward, way);
  f[kSideHeads] = angle(a.heading.norm() > 0 ? Vector2f(a.heading.normalized()) : a.outward, way);
  f[kSideAside] = std::log1p(std::abs(aside));
  f[kSideAhead] = std::copysign(std::log1p(std::abs(ahead)), ahead);
  f[kSideCurves] = std::clamp(a.curvature * w * (aside < 0 ? -1.0F : 1.0F), -1.0F, 1.0F);
  if (a.depth_m > 0 && b.depth_m > 0) {
    f[kSideSlope] = std::clamp(a.slope_per_px / metres_per_px(a, b, cover), -kMost, kMost);
  }
  return f;
}

PairFeatures pair_features(int from, int to, const Link& link, const Strands& strands,
                           const Cover& cover) {
  const StrandEnd& a = strands.end(from);
  const StrandEnd& b = strands.end(to);
  const float w = scale_between(a, b, strands);
  const float chord = (b.point_px - a.point_px).norm();
  PairFeatures f{};
  std::copy(link.terms.begin(), link.terms.end(), f.begin());
  f[kPairChord] = std::log1p(chord / w);
  f[kPairDetour] = std::log((link.curve.length_px + 0.5F * w) / (chord + 0.5F * w));
  f[kPairBend] = log_bend(link.curve);
  f[kPairTurn] = angle(-a.outward, b.outward);
  f[kPairOwn] = from / 2 == to / 2 ? 1.0F : 0.0F;
  if (a.look.width_px > 0 && b.look.width_px > 0) {
    f[kPairWidths] = std::abs(std::log(a.look.width_px / b.look.width_px));
  }
  if (a.depth_m > 0 && b.depth_m > 0) {
    const float unit = metres_per_px(a, b, cover) * w;
    f[kPairDeep] = 1;
    f[kPairApart] = std::log1p(std::abs(b.depth_m - a.depth_m) / unit);
    f[kPairUneven] = std::log1p(uneven_m(a, b) / unit);
  }
  f[kPairWorst] = 1;
  for (int i = 0; i < kCurveSamples; ++i) {
    const float t = sample_t(i);
    const Vector2f p = link.curve.cubic.at(t);
    const Vector2f along = link.curve.cubic.first_derivative(t);
    const bool runs = along.norm() > 0;
    const Sight seen = cover.at(p, (1 - t) * a.depth_m + t * b.depth_m);
    const auto shown = runs ? cover.shown(p, along.normalized()) : field::FieldView::Shown{};
    constexpr float kShare = 1.0F / kCurveSamples;
    f[kPairHidden] += seen == Sight::kHidden ? kShare : 0.0F;
    f[kPairOpen] += seen == Sight::kOpen ? kShare : 0.0F;
    f[kPairMasked] += cover.masked(p) ? kShare : 0.0F;
    f[kPairShown] += kShare * shown.any();
    f[kPairBelow] += kShare * shown.below;
    f[kPairWorst] = std::min(f[kPairWorst], shown.any());
  }
  const float widths = link.curve.length_px / w;
  f[kPairOpenFar] = std::log1p(f[kPairOpen] * widths);
  f[kPairBare] = std::log1p(std::max(0.0F, f[kPairMasked] - f[kPairShown]) * widths);
  return f;
}

}  // namespace flowdlo::path
