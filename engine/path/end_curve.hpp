// EndCurve: a cubic from one strand's end to another's, and how much it bends.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>

#include "path/strands.hpp"

namespace flowdlo::path {

/// What a derivative of a cubic in Hermite's form consists of.
struct SlopeWeights {
  float chord, a, b;  ///< of b - a, and of the derivatives at a and b
};
[[nodiscard]] constexpr SlopeWeights first_weights(float t) {
  return {6 * t - 6 * t * t, 1 - 4 * t + 3 * t * t, 3 * t * t - 2 * t};
}
[[nodiscard]] constexpr SlopeWeights second_weights(float t) {
  return {6 - 12 * t, 6 * t - 4, 6 * t - 2};
}

/// In Hermite's form, over t in [0, 1].
struct Cubic {
  Eigen::Vector2f a, b;    ///< points
  Eigen::Vector2f da, db;  ///< derivatives there, along the way

  [[nodiscard]] Eigen::Vector2f at(float t) const {
    const float t2 = t * t;
    const float t3 = t2 * t;
    return (2 * t3 - 3 * t2 + 1) * a + (t3 - 2 * t2 + t) * da + (3 * t2 - 2 * t3) * b +
           (t3 - t2) * db;
  }
  [[nodiscard]] Eigen::Vector2f first_derivative(float t) const {
    const SlopeWeights weights = first_weights(t);
    return weights.chord * (b - a) + weights.a * da + weights.b * db;
  }
};

/// How long both tangents are tried, over the chord.
inline constexpr std::array kTangents{0.5F, 1.0F, 1.6F, 2.6F};

inline constexpr int kCurveSamples = 12;

/// The middle of one of the kCurveSamples stretches, in t.
[[nodiscard]] inline float sample_t(int i) {
  return (static_cast<float>(i) + 0.5F) / kCurveSamples;
}

struct EndCurve {
  Cubic cubic{};
  std::array<float, kCurveSamples> steps{};  ///< pixels of each stretch
  float length_px = 0;
  float bending = 0;  ///< energy times length: free of units; for an arc, its turn squared
};

/// log(1 + B / 0.1), B: how much the curve bends; less than 0.1 hardly tells.
[[nodiscard]] inline float log_bend(const EndCurve& curve) {
  return std::log1p(curve.bending / 0.1F);
}

/// The cubic with tangents of `leaves` and `enters` chords along the ends' headings; ends within
/// half of `scale_px` have no curve between them, and bend by their turn. Bends are told from how
/// the ends themselves bend on.
[[nodiscard]] EndCurve end_curve(const StrandEnd& from, const StrandEnd& to, float leaves,
                                 float enters, float scale_px);

}  // namespace flowdlo::path
