// Candidate: a centerline that an estimate may return, and what speaks for it without any truth.
#pragma once

#include <array>
#include <cstddef>

#include "flowdlo/centerline.hpp"
#include "gate/tube_score.hpp"

namespace flowdlo::gate {

/// A prior, or a draw's prediction beside the prior that conditioned it.
struct Candidate {
  Centerline nodes{};
  int draw = -1;       ///< -1: a prior
  int hypothesis = 0;  ///< which traversal it rests on
  TubeScore tube;      ///< how it looks beside mask and depth; the worst where it cannot be drawn
  double behind = 0;   ///< path score by which its traversal trails the best; at least 0
  float longest_gap = 0;  ///< of its traversal, rope widths
  float bridged = 0;      ///< [0, 1] share of its traversal on links over gaps
  float supported = 0;    ///< [0, 1] share of nodes with support
  float radius_m = 0;     ///< of the rope, as the mask has it
  float moved_m = 0;      ///< mean distance of a prediction from its prior; 0 of a prior
  float spread_m = 0;     ///< mean spread of the draws around their mean; 0 with a single one
  float sigma_m = 0;      ///< mean of the model's own sigma; 0 where it says nothing
};

/// [kCandidateFeatures] each in [-1, 1]; the first is one.
inline constexpr std::size_t kCandidateFeatures = 20;
[[nodiscard]] std::array<double, kCandidateFeatures> candidate_features(const Candidate& candidate);

}  // namespace flowdlo::gate
