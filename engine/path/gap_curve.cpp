#include "path/gap_curve.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "path/end_curve.hpp"

namespace flowdlo::path {
namespace {

using Eigen::Vector2f;

constexpr int kFineRounds = 10;
constexpr float kFineFactor = 1.15F;
constexpr float kMostBending = 20.0F;
constexpr float kWidths = 6.0F;        // a unit for each six widths of length
constexpr float kShapeBending = 1.0F;  // the curve drawn bends as little as it can;
constexpr float kLinkBending = 0.2F;   // as a link it had better bend on as the ends do
constexpr float kOpenCost = 8.0F;      // where the background shows, at most;
constexpr float kOpenWidths = 4.0F;    // most of it for this many widths;
constexpr float kSlitCost = 1.0F;      // and however short, for tips show there
constexpr float kSlitWidths = 0.3F;

// No curve is shorter than its chord, nor as it is sampled than this share of it: with n samples
// and tangents of a and b chords 1 + (2 - a - b) / (4 n^2) is the least.
constexpr float kSampledChord =
    0.999F + (2 - 2 * kTangents.back()) / (4.0F * kCurveSamples * kCurveSamples);

enum class Purpose : std::uint8_t { kLink, kShape };

class Gap {
 public:
  Gap(const StrandEnd& from, const StrandEnd& to, const Cover& cover, float scale_px)
      : from_(from), to_(to), cover_(cover), scale_px_(scale_px) {}

  // The cheapest cubic over a grid of both tangents' lengths, those first that bend least; depths
  // are looked up only where the rest leaves room below `most`.
  float search(Purpose purpose, float most = std::numeric_limits<float>::max()) {
    purpose_ = purpose;
    const float chord_px = (to_.point_px - from_.point_px).norm();
    if (kSampledChord * chord_px / (kWidths * scale_px_) >= most) return least_;
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

  [[nodiscard]] Cubic cubic() const { return curve_.cubic; }
  [[nodiscard]] float length_px() const { return curve_.length_px; }

 private:
  /// A curve, and what its length and its bends cost.
  struct Attempt {
    float leaves = 1;
    float enters = 1;
    EndCurve curve{};
    float cost = 0;
  };

  [[nodiscard]] Attempt drawn(float leaves, float enters) const {
    const bool link = purpose_ == Purpose::kLink;
    Attempt attempt{leaves, enters, end_curve(from_, to_, leaves, enters, scale_px_, link)};
    const float bending = std::min(kMostBending, attempt.curve.bending);
    attempt.cost = attempt.curve.length_px / (kWidths * scale_px_) +
                   (link ? kLinkBending : kShapeBending) * bending;
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
    curve_ = attempt.curve;
    return true;
  }

  // What the attempt costs, depths and all; where that is `limit` or more, no less than `limit`.
  [[nodiscard]] float cost_below(float limit, const Attempt& attempt) const {
    if (from_.depth_m <= 0 || to_.depth_m <= 0) return attempt.cost;
    float open_px = 0;
    float cost = attempt.cost;
    for (int i = 0; i < kCurveSamples && cost < limit; ++i) {
      const float t = sample_t(i);
      const float rope_m = (1 - t) * from_.depth_m + t * to_.depth_m;
      if (!cover_.open(attempt.curve.cubic.at(t), rope_m)) continue;
      open_px += attempt.curve.steps[i];
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
  EndCurve curve_{};
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
