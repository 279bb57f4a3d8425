#include "path/gap_curve.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "path/cubic.hpp"

namespace flowdlo::path {
namespace {

using Eigen::Vector2f;

constexpr std::array kTangents{0.5F, 1.0F, 1.6F, 2.6F};  // over the chord
constexpr int kSamples = 12;
constexpr int kFineRounds = 10;
constexpr float kFineFactor = 1.15F;
constexpr float kMostBending = 20.0F;
constexpr float kWidths = 6.0F;         // a unit for each six widths of length
constexpr float kShapeBending = 1.0F;   // the curve drawn bends as little as it can;
constexpr float kLinkBending = 0.2F;    // as a link it had better bend on as the ends do
constexpr float kNearestWidths = 0.5F;  // ends nearer than this have no curve between them
constexpr float kOpenCost = 8.0F;       // where the background shows, at most;
constexpr float kBelow_m = 0.03F;       // so does another strand this far below
constexpr float kOpenWidths = 4.0F;     // most of it for this many widths;
constexpr float kSlitCost = 1.0F;       // and however short, for tips show there
constexpr float kSlitWidths = 0.3F;

enum class Purpose : std::uint8_t { kLink, kShape };

class Gap {
 public:
  Gap(const StrandEnd& from, const StrandEnd& to, const Cover& cover, float scale_px)
      : from_(from), to_(to), cover_(cover), scale_px_(scale_px) {}

  // The cheapest cubic over a grid of both tangents' lengths, those first that bend least; depths
  // are looked up only where the rest leaves room below `most`.
  float search(Purpose purpose, float most = std::numeric_limits<float>::max()) {
    purpose_ = purpose;
    std::array<Attempt, kTangents.size() * kTangents.size()> attempts;
    std::size_t count = 0;
    for (const float out : kTangents) {
      for (const float in : kTangents) attempts[count++] = drawn(out, in);
    }
    std::stable_sort(attempts.begin(), attempts.end(),
                     [](const Attempt& a, const Attempt& b) { return a.cost < b.cost; });
    for (const Attempt& attempt : attempts) {
      if (attempt.cost >= std::min(most, least_)) break;
      accept(attempt, most);
    }
    return least_;
  }

  void refine() {
    for (int round = 0; round < kFineRounds; ++round) {
      bool better = accept(drawn(leaves_ * kFineFactor, enters_));
      better = accept(drawn(leaves_ / kFineFactor, enters_)) || better;
      better = accept(drawn(leaves_, enters_ * kFineFactor)) || better;
      better = accept(drawn(leaves_, enters_ / kFineFactor)) || better;
      if (!better) return;
    }
  }

  [[nodiscard]] Cubic cubic() const { return cubic_of(leaves_, enters_); }
  [[nodiscard]] float length_px() const { return length_px_; }

 private:
  [[nodiscard]] Cubic cubic_of(float leaves, float enters) const {
    const Vector2f chord = to_.point_px - from_.point_px;
    return {from_.point_px, to_.point_px, leaves * chord.norm() * from_.heading,
            -enters * chord.norm() * to_.heading};
  }

  /// A cubic, and what its length and its bends cost.
  struct Attempt {
    float leaves = 1;
    float enters = 1;
    Cubic cubic{};
    std::array<float, kSamples> steps{};
    float length = 0;
    float cost = 0;
  };

  [[nodiscard]] Attempt drawn(float leaves, float enters) const {
    Attempt attempt{leaves, enters, cubic_of(leaves, enters)};
    const Cubic& cubic = attempt.cubic;
    const Vector2f chord = cubic.b - cubic.a;
    float length = 0;
    float energy = 0;
    for (int i = 0; i < kSamples; ++i) {
      const float t = (static_cast<float>(i) + 0.5F) / kSamples;
      const Vector2f d1 = cubic.first_derivative(t);
      const Vector2f d2 = cubic.second_derivative(t);
      const float speed = std::max(d1.norm(), 1e-3F);
      float bend = (d1.x() * d2.y() - d1.y() * d2.x()) / (speed * speed * speed);
      if (purpose_ == Purpose::kLink) bend -= (1 - t) * from_.curvature - t * to_.curvature;
      attempt.steps[i] = speed / kSamples;
      length += attempt.steps[i];
      energy += bend * bend * attempt.steps[i];
    }
    const float weight = purpose_ == Purpose::kLink ? kLinkBending : kShapeBending;
    attempt.length = length;
    attempt.cost = length / (kWidths * scale_px_) + weight * bending(energy * length, chord.norm());
    return attempt;
  }

  // Whether the attempt is the best so far and below `most`, depths and all.
  bool accept(const Attempt& attempt, float most = std::numeric_limits<float>::max()) {
    const float limit = std::min(most, least_);
    if (attempt.cost >= limit) return false;
    const float cost = cost_below(limit, attempt);
    if (cost >= limit) return false;
    least_ = cost;
    leaves_ = attempt.leaves;
    enters_ = attempt.enters;
    length_px_ = attempt.length;
    return true;
  }

  // Energy times length is free of units: for an arc, its turn squared.
  [[nodiscard]] float bending(float energy, float chord_px) const {
    if (chord_px >= kNearestWidths * scale_px_) return std::min(kMostBending, energy);
    const float turn = std::acos(std::clamp(-from_.heading.dot(to_.heading), -1.0F, 1.0F));
    return turn * turn;
  }

  // What the attempt costs, depths and all; where that is `limit` or more, no less than `limit`.
  [[nodiscard]] float cost_below(float limit, const Attempt& attempt) const {
    if (from_.depth_m <= 0 || to_.depth_m <= 0) return attempt.cost;
    float open_px = 0;
    float cost = attempt.cost;
    for (int i = 0; i < kSamples && cost < limit; ++i) {
      const float t = (static_cast<float>(i) + 0.5F) / kSamples;
      const Vector2f p = attempt.cubic.at(t);
      const float rope_m = (1 - t) * from_.depth_m + t * to_.depth_m;
      const bool open = cover_.masked(p) ? cover_.rope_depth(p) > rope_m + kBelow_m
                                         : cover_.at(p, rope_m) == Sight::kOpen;
      if (!open) continue;
      open_px += attempt.steps[i];
      cost = attempt.cost + open_cost(open_px);
    }
    return cost;
  }

  // Of so many pixels where the background shows.
  [[nodiscard]] float open_cost(float open_px) const {
    return kOpenCost * (1 - std::exp(-open_px / (kOpenWidths * scale_px_))) +
           kSlitCost * (1 - std::exp(-open_px / (kSlitWidths * scale_px_)));
  }

  const StrandEnd& from_;
  const StrandEnd& to_;
  const Cover& cover_;
  float scale_px_;
  Purpose purpose_ = Purpose::kLink;
  float least_ = std::numeric_limits<float>::max();
  float leaves_ = 1;
  float enters_ = 1;
  float length_px_ = 0;
};

}  // namespace

float gap_cost(const StrandEnd& from, const StrandEnd& to, const Cover& cover, float scale_px,
               float most) {
  return Gap(from, to, cover, scale_px).search(Purpose::kLink, most);
}

std::vector<Vector2f> gap_points(const StrandEnd& from, const StrandEnd& to, const Cover& cover,
                                 float scale_px) {
  Gap gap(from, to, cover, scale_px);
  gap.search(Purpose::kShape);
  gap.refine();
  const Cubic cubic = gap.cubic();
  const int steps = static_cast<int>(std::ceil(gap.length_px()));
  std::vector<Vector2f> points;
  for (int i = 1; i < steps; ++i) {
    points.push_back(cubic.at(static_cast<float>(i) / static_cast<float>(steps)));
  }
  return points;
}

}  // namespace flowdlo::path
