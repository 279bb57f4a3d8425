#include "path/gap_curve.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace flowdlo::path {
namespace {

using Eigen::Vector2f;

constexpr std::array kTangents{0.5F, 1.0F, 1.6F, 2.6F};  // over the chord
constexpr int kSamples = 12;
constexpr int kFineRounds = 10;
constexpr float kFineFactor = 1.15F;
constexpr float kMostBending = 20.0F;
constexpr float kGapBending = 0.4F;  // a hidden stretch may bend
constexpr float kGapWidths = 6.0F;   // a unit for each six widths of length
constexpr float kOpenCost = 8.0F;    // where the background shows, at most;
constexpr float kOpenWidths = 4.0F;  // most of it for this many widths

struct Ends {
  Vector2f a, b;    // points
  Vector2f da, db;  // unit directions there, along the way
  float za, zb;     // depths
};

Vector2f at(const Ends& e, const Vector2f& leaves, const Vector2f& enters, float t) {
  const float t2 = t * t;
  const float t3 = t2 * t;
  return (2 * t3 - 3 * t2 + 1) * e.a + (t3 - 2 * t2 + t) * leaves + (3 * t2 - 2 * t3) * e.b +
         (t3 - t2) * enters;
}

GapCurve measured(const Ends& e, float leaves, float enters, const Cover& cover, float scale_px) {
  GapCurve curve;
  curve.leaves_px = leaves * e.da;
  curve.enters_px = enters * e.db;
  const Vector2f chord = e.b - e.a;
  float energy = 0;
  for (int i = 0; i < kSamples; ++i) {
    const float t = (static_cast<float>(i) + 0.5F) / kSamples;
    const Vector2f d1 = (6 * t - 6 * t * t) * chord + (1 - 4 * t + 3 * t * t) * curve.leaves_px +
                        (3 * t * t - 2 * t) * curve.enters_px;
    const Vector2f d2 =
        (6 - 12 * t) * chord + (6 * t - 4) * curve.leaves_px + (6 * t - 2) * curve.enters_px;
    const float speed = std::max(d1.norm(), 1e-3F);
    const float cross = d1.x() * d2.y() - d1.y() * d2.x();
    const float step = speed / kSamples;
    const float curvature = cross / (speed * speed * speed);
    curve.length_px += step;
    energy += curvature * curvature * step;
    const Vector2f p = at(e, curve.leaves_px, curve.enters_px, t);
    const float rope_m = e.za > 0 && e.zb > 0 ? (1 - t) * e.za + t * e.zb : 0;
    if (!cover.masked(p) && cover.at(p, rope_m) == Sight::kOpen) curve.open_px += step;
  }
  curve.bending = std::min(kMostBending, energy * curve.length_px);
  if (chord.norm() < 0.5F * scale_px) {
    const float turn = std::acos(std::clamp(e.da.dot(e.db), -1.0F, 1.0F));
    curve.bending = std::min(kMostBending, turn * turn);
  }
  return curve;
}

}  // namespace

float cost_of(const GapCurve& curve, float scale_px) {
  const float open = curve.open_px / (kOpenWidths * scale_px);
  return curve.length_px / (kGapWidths * scale_px) + kGapBending * curve.bending +
         kOpenCost * (1 - std::exp(-open));
}

GapCurve gap_curve(const StrandEnd& from, const StrandEnd& to, const Cover& cover, float scale_px,
                   bool fine) {
  const Ends ends{from.point_px, to.point_px, from.outward, -to.outward, from.depth_m, to.depth_m};
  const float chord = std::max((ends.b - ends.a).norm(), 1e-3F);
  GapCurve best;
  float least = 0;
  float leaves = 1;
  float enters = 1;
  const auto attempt = [&](float out, float in) {
    const GapCurve curve = measured(ends, out * chord, in * chord, cover, scale_px);
    const float cost = cost_of(curve, scale_px);
    if (best.length_px > 0 && cost >= least) return false;
    best = curve;
    least = cost;
    leaves = out;
    enters = in;
    return true;
  };
  for (const float out : kTangents) {
    for (const float in : kTangents) attempt(out, in);
  }
  for (int round = 0; fine && round < kFineRounds; ++round) {
    const float out = leaves;
    const float in = enters;
    bool better = attempt(out * kFineFactor, in);
    better = attempt(out / kFineFactor, in) || better;
    better = attempt(leaves, in * kFineFactor) || better;
    better = attempt(leaves, in / kFineFactor) || better;
    if (!better) break;
  }
  return best;
}

std::vector<Vector2f> points_of(const GapCurve& curve, const StrandEnd& from, const StrandEnd& to) {
  const Ends ends{from.point_px, to.point_px, {}, {}, 0, 0};
  const int steps = static_cast<int>(std::ceil(curve.length_px));
  std::vector<Vector2f> points;
  for (int i = 1; i < steps; ++i) {
    const float t = static_cast<float>(i) / static_cast<float>(steps);
    points.push_back(at(ends, curve.leaves_px, curve.enters_px, t));
  }
  return points;
}

}  // namespace flowdlo::path
