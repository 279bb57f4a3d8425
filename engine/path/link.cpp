#include "path/link.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace flowdlo::path {
namespace {

using Eigen::Vector2f;

constexpr int kFineRounds = 10;          // of the tangents that are drawn, each
constexpr float kFineFactor = 1.15F;     // so much longer or shorter
constexpr float kFollowedWidths = 1.0F;  // a strand that shows farther from both ends has its line
constexpr float kShown = 0.4F;           // of the field: as much as shows it surely
constexpr float kLongWidths = 3.0F;      // scales of the terms, in widths
constexpr float kOpenWidths = 0.3F;
constexpr float kUnshownWidths = 2.0F;
constexpr float kDepthNoise_m = 0.002F;
constexpr float kDepthNoise = 0.2F;  // metres of depth a metre along the link

float saturated(float length, float scale) { return 1 - std::exp(-length / scale); }

// How badly the depths on both sides fit one smooth strand.
float depth_misfit(const StrandEnd& from, const StrandEnd& to, float width_px, float focal_px) {
  if (from.depth_m <= 0 || to.depth_m <= 0 || focal_px <= 0) return 0;
  const float length_px = (to.point_px - from.point_px).norm();
  const float metres_per_px = 0.5F * (from.depth_m + to.depth_m) / focal_px;
  const float off = uneven_m(from, to);
  const float noise = kDepthNoise_m + (0.5F * width_px + kDepthNoise * length_px) * metres_per_px;
  return std::log1p(0.5F * (off / noise) * (off / noise));
}

class Linker {
 public:
  Linker(const StrandEnd& from, const StrandEnd& to, const Cover& cover, const LinkConfig& config)
      : from_(from), to_(to), cover_(cover), config_(config), w_(config.scale_px) {
    fit_[kLinkColor] = color_misfit(from.look, to.look);
    fit_[kLinkHeard] = config.elsewhere;
    fit_[kLinkDepth] = depth_misfit(from, to, w_, cover.focal_px());
  }

  // Over a grid of both tangents' lengths, those first that bend least; mask, depth and field are
  // looked up only where the rest leaves room below `most`.
  Link search(float most) {
    std::array<Attempt, kTangents.size() * kTangents.size()> attempts;
    std::size_t count = 0;
    for (const float out : kTangents) {
      for (const float in : kTangents) attempts[count++] = drawn(out, in);
    }
    std::stable_sort(attempts.begin(), attempts.end(),
                     [](const Attempt& a, const Attempt& b) { return a.energy < b.energy; });
    best_.energy = most;
    for (const Attempt& attempt : attempts) {
      if (attempt.energy >= best_.energy) break;
      accept(attempt);
    }
    return best_;
  }

  // Tangents a little longer and shorter, as long as that is better. How long a link is says
  // whether it is one, not how it runs.
  Link refined() {
    config_.weights[kLinkLong] = 0;
    (void)search(std::numeric_limits<float>::max());
    bool better = true;
    for (int round = 0; better && round < kFineRounds; ++round) {
      better = accept(drawn(leaves_ * kFineFactor, enters_));
      better = accept(drawn(leaves_ / kFineFactor, enters_)) || better;
      better = accept(drawn(leaves_, enters_ * kFineFactor)) || better;
      better = accept(drawn(leaves_, enters_ / kFineFactor)) || better;
    }
    return best_;
  }

 private:
  struct Attempt {
    float leaves = 1;
    float enters = 1;
    EndCurve curve{};
    LinkTerms terms{};
    float energy = 0;
  };

  // A curve, and what its length and its bends cost.
  [[nodiscard]] Attempt drawn(float leaves, float enters) const {
    Attempt attempt{leaves, enters, end_curve(from_, to_, leaves, enters, w_), fit_};
    const float bend = log_bend(attempt.curve);
    attempt.terms[kLinkLong] = std::log1p(attempt.curve.length_px / (kLongWidths * w_));
    attempt.terms[kLinkBend] = config_.trust * bend;
    attempt.terms[kLinkStump] = (1 - config_.trust) * bend;
    attempt.energy = energy_of(attempt.terms, config_.weights);
    return attempt;
  }

  // Whether the attempt is the best so far, with what mask, depth and field show along it.
  bool accept(Attempt attempt) {
    if (attempt.energy >= best_.energy) return false;
    look(attempt);
    if (attempt.energy >= best_.energy) return false;
    best_ = {attempt.terms, attempt.energy, attempt.curve};
    leaves_ = attempt.leaves;
    enters_ = attempt.enters;
    return true;
  }

  // What shows along the curve; no farther than it takes to tell that the best so far is better.
  void look(Attempt& attempt) const {
    const EndCurve& curve = attempt.curve;
    const bool depths_known = from_.depth_m > 0 && to_.depth_m > 0;
    float open_px = 0;
    float unshown_px = 0;
    float walked_px = 0;
    for (int i = 0; i < kCurveSamples; ++i) {
      const float t = sample_t(i);
      const float step = curve.steps[i];
      const Vector2f p = curve.cubic.at(t);
      const float to_end =
          std::min(walked_px + 0.5F * step, curve.length_px - walked_px - 0.5F * step);
      walked_px += step;
      const bool masked = cover_.masked(p);
      const bool bare = cover_.has_field() && masked;
      const bool unsure = !cover_.has_field() && !masked && cover_.near_mask(p);
      const bool open =
          depths_known && !unsure && cover_.open(p, (1 - t) * from_.depth_m + t * to_.depth_m);
      if (!bare && !open) continue;
      const float missed = (1 - shown(p, curve.cubic.first_derivative(t), to_end)) * step;
      if (bare) unshown_px += missed;
      if (open) open_px += missed;
      attempt.terms[kLinkOpen] = saturated(open_px, kOpenWidths * w_);
      attempt.terms[kLinkUnshown] = saturated(unshown_px, kUnshownWidths * w_);
      attempt.energy = energy_of(attempt.terms, config_.weights);
      if (attempt.energy >= best_.energy) return;  // nothing that follows makes it less
    }
  }

  // [0, 1] how surely the field shows a strand that runs along `way` at `p`, so far from the ends.
  [[nodiscard]] float shown(const Vector2f& p, const Vector2f& way, float to_end) const {
    if (way.norm() <= 0) return 0;
    const auto shown = cover_.shown(p, way.normalized());
    const bool below = to_end > kFollowedWidths * w_;
    return std::min(1.0F, (below ? shown.below : shown.any()) / kShown);
  }

  const StrandEnd& from_;
  const StrandEnd& to_;
  const Cover& cover_;
  LinkConfig config_;
  float w_;
  LinkTerms fit_{};  // what does not depend on the curve
  Link best_{};
  float leaves_ = 1;
  float enters_ = 1;
};

}  // namespace

float uneven_m(const StrandEnd& from, const StrandEnd& to) {
  const float length_px = (to.point_px - from.point_px).norm();
  const float expected = 0.5F * length_px * (from.slope_per_px - to.slope_per_px);
  return std::abs(to.depth_m - from.depth_m - expected);
}

Link best_link(const StrandEnd& from, const StrandEnd& to, const Cover& cover,
               const LinkConfig& config, float most) {
  return Linker(from, to, cover, config).search(most);
}

std::vector<Vector2f> link_points(const StrandEnd& from, const StrandEnd& to, const Cover& cover,
                                  const LinkConfig& config) {
  const EndCurve curve = Linker(from, to, cover, config).refined().curve;
  const auto steps = static_cast<int>(std::ceil(curve.length_px));
  std::vector<Vector2f> points;
  for (int i = 1; i < steps; ++i) {
    points.push_back(curve.cubic.at(static_cast<float>(i) / static_cast<float>(steps)));
  }
  return points;
}

float least_energy(float length_px, const LinkTerms& weights, float scale_px) {
  return weights[kLinkLong] * std::log1p(length_px / (kLongWidths * scale_px));
}

}  // namespace flowdlo::path
