#include "path/link.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "path/cubic.hpp"

namespace flowdlo::path {
namespace {

using Eigen::Vector2f;

constexpr std::array kTangents{0.5F, 1.0F, 1.6F, 2.6F};  // over the chord
constexpr int kSamples = 12;
constexpr float kBend = 0.1F;            // L times the integral of bend^2 that hardly tells
constexpr float kNearestWidths = 0.5F;   // ends nearer than this have no curve between them
constexpr float kFollowedWidths = 1.0F;  // a strand that shows farther from both ends has its line
constexpr float kBelow_m = 0.03F;        // another strand this far below is background
constexpr float kShown = 0.4F;           // of the field: as much as shows it surely
constexpr float kLongWidths = 3.0F;      // scales of the terms, in widths
constexpr float kOpenWidths = 0.3F;
constexpr float kUnshownWidths = 2.0F;

float saturated(float length, float scale) { return 1 - std::exp(-length / scale); }

class Linker {
 public:
  Linker(const StrandEnd& from, const StrandEnd& to, const Cover& cover, float scale_px,
         float trust)
      : from_(from), to_(to), cover_(cover), w_(scale_px), trust_(trust) {}

  Link search(float most) {
    std::array<Attempt, kTangents.size() * kTangents.size()> attempts;
    std::size_t count = 0;
    for (const float out : kTangents) {
      for (const float in : kTangents) attempts[count++] = drawn(out, in);
    }
    std::stable_sort(attempts.begin(), attempts.end(),
                     [](const Attempt& a, const Attempt& b) { return a.energy < b.energy; });
    Link best;
    best.energy = most;
    for (Attempt& attempt : attempts) {
      if (attempt.energy >= best.energy) break;
      look(attempt);
      if (attempt.energy < best.energy) best = {attempt.terms, attempt.energy};
    }
    return best;
  }

 private:
  struct Attempt {
    Cubic cubic{};
    std::array<float, kSamples> steps{};
    float length = 0;
    LinkTerms terms{};
    float energy = 0;
  };

  // A cubic, and what its length and its bends cost.
  [[nodiscard]] Attempt drawn(float leaves, float enters) const {
    Attempt attempt;
    const float chord = (to_.point_px - from_.point_px).norm();
    attempt.cubic = {from_.point_px, to_.point_px, leaves * chord * from_.heading,
                     -enters * chord * to_.heading};
    float relative = 0;
    for (int i = 0; i < kSamples; ++i) {
      const float t = (static_cast<float>(i) + 0.5F) / kSamples;
      const Vector2f d1 = attempt.cubic.first_derivative(t);
      const Vector2f d2 = attempt.cubic.second_derivative(t);
      const float speed = std::max(d1.norm(), 1e-3F);
      const float bend = (d1.x() * d2.y() - d1.y() * d2.x()) / (speed * speed * speed);
      const float own = (1 - t) * from_.curvature - t * to_.curvature;
      attempt.steps[i] = speed / kSamples;
      attempt.length += attempt.steps[i];
      relative += (bend - own) * (bend - own) * attempt.steps[i];
    }
    relative *= attempt.length;
    if (chord < kNearestWidths * w_) {
      const float turn = std::acos(std::clamp(-from_.heading.dot(to_.heading), -1.0F, 1.0F));
      relative = turn * turn;
    }
    relative = std::log1p(relative / kBend);
    attempt.terms[kLinkLong] = std::log1p(attempt.length / (kLongWidths * w_));
    attempt.terms[kLinkBend] = trust_ * relative;
    attempt.terms[kLinkStump] = (1 - trust_) * relative;
    attempt.energy = energy_of(attempt.terms, kLinkWeights);
    return attempt;
  }

  // What mask, depth and field show along it.
  void look(Attempt& attempt) const {
    float open_px = 0;
    float unshown_px = 0;
    float walked_px = 0;
    for (int i = 0; i < kSamples; ++i) {
      const float t = (static_cast<float>(i) + 0.5F) / kSamples;
      const float step = attempt.steps[i];
      const Vector2f p = attempt.cubic.at(t);
      const Vector2f d1 = attempt.cubic.first_derivative(t);
      const float to_end =
          std::min(walked_px + 0.5F * step, attempt.length - walked_px - 0.5F * step);
      walked_px += step;
      const bool below = to_end > kFollowedWidths * w_;
      const float shown =
          d1.norm() > 0 ? std::min(1.0F, cover_.shown(p, d1.normalized(), below) / kShown) : 0.0F;
      const bool masked = cover_.masked(p);
      if (masked) unshown_px += (1 - shown) * step;
      if (open(p, t, masked)) open_px += (1 - shown) * step;
    }
    attempt.terms[kLinkOpen] = saturated(open_px, kOpenWidths * w_);
    attempt.terms[kLinkUnshown] = saturated(unshown_px, kUnshownWidths * w_);
    attempt.energy = energy_of(attempt.terms, kLinkWeights);
  }

  // Whether something behind the rope shows at `p`.
  [[nodiscard]] bool open(const Vector2f& p, float t, bool masked) const {
    if (from_.depth_m <= 0 || to_.depth_m <= 0) return false;
    const float rope_m = (1 - t) * from_.depth_m + t * to_.depth_m;
    return masked ? cover_.rope_depth(p) > rope_m + kBelow_m : cover_.at(p, rope_m) == Sight::kOpen;
  }

  const StrandEnd& from_;
  const StrandEnd& to_;
  const Cover& cover_;
  float w_;
  float trust_;
};

}  // namespace

Link best_link(const StrandEnd& from, const StrandEnd& to, const Cover& cover, float scale_px,
               float trust, float most) {
  return Linker(from, to, cover, scale_px, trust).search(most);
}

float least_energy(float length_px, float scale_px) {
  return kLinkWeights[kLinkLong] * std::log1p(length_px / (kLongWidths * scale_px));
}

}  // namespace flowdlo::path
