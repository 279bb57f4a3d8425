// RopeConfidence: how sure the estimate of one rope of several is.
#pragma once

#include "flowdlo/estimate.hpp"

namespace flowdlo::estimator {

/// What else says that a rope is one.
enum class Witness {
  kNone,     ///< nothing: there was one reading
  kAgrees,   ///< a second reading has the same rope
  kDiffers,  ///< the second reading has none like it
  kLabel,    ///< a label of the frame
};

/// How a rope was told apart.
struct ToldApart {
  Witness witness = Witness::kNone;
  float lead = 0;  ///< what any set of ropes without it costs more, path::RopePaths
};

/// The log odds of an estimate's own confidence, within bounds that a fit can heed.
[[nodiscard]] double own_log_odds(double confidence);

/// [0, 1] the probability that a rope, a ring where it is `closed`, is one of the frame's, visited
/// in order from end to end, and less than 1 cm off, Eq. (4.1): by how it was told apart and by the
/// probability of its estimate in its own view. That one says nothing of a ring: it was fitted to
/// ropes with two ends.
[[nodiscard]] double rope_probability(const ToldApart& told, bool closed, double own);

/// The same of an estimate by its confidence; its doubts lower it as they lower that of a single
/// rope.
[[nodiscard]] float rope_confidence(const ToldApart& told, const Estimate& rope);

}  // namespace flowdlo::estimator
