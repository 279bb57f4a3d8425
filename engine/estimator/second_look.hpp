// SecondLook: where the first reading of a mask leaves doubt, what further readings make of it, and
// how many of them agree.
#pragma once

#include <vector>

#include "estimator/conditions.hpp"
#include "flowdlo/frame.hpp"
#include "weights/variant.hpp"

namespace flowdlo::estimator {

/// How sure the first reading has to be of its best hypothesis to be left alone, `confidence`.
inline constexpr float kClear = 0.7F;

/// Whether it is less sure than that, and another one may be surer: neither noise nor a tangle of
/// more strands than path::kMostRereadStrands is read again.
[[nodiscard]] bool in_doubt(const Conditions& conditions);

struct SecondLook {
  int readings = 1;                      ///< of the mask, the first among them
  std::vector<Hypothesis> hypotheses{};  ///< those of the first reading as they were, best first,
                                         ///< then others that run elsewhere, best first
};

/// At most `threads` readings at a time; 0: one for each core. `conditions` are of the frame.
/// Readings that fail are left out. Without doubt the hypotheses are the conditions'.
[[nodiscard]] SecondLook look_again(const Conditions& conditions, const Frame& frame,
                                    double rope_length_m, weights::PriorKind kind, int threads);

}  // namespace flowdlo::estimator
