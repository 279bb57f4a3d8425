// Refinement: a hypothesis with its nodes where the refining networks see the rope's axis and tips.
#pragma once

#include "estimator/second_look.hpp"
#include "flowdlo/frame.hpp"
#include "flowdlo/hints.hpp"
#include "flowdlo/result.hpp"
#include "gate/candidate.hpp"
#include "refine/network.hpp"
#include "refine/refined.hpp"
#include "refine/strip.hpp"

namespace flowdlo::estimator {

/// A candidate as the refining networks are told about it.
[[nodiscard]] refine::Curve curve_of(const gate::Candidate& candidate);

/// As refine::refined() of a prior of this frame: the networks have seen no other. Its ends go
/// where `hints` say that they are, if that is near; a ring has none to move, and without a strand
/// field in `look` the others stay. `rope_length_m` 0: unknown.
[[nodiscard]] Result<refine::Refined> refined(const gate::Candidate& prior, const SecondLook& look,
                                              const Frame& frame, refine::Network& network,
                                              double rope_length_m, const Hints& hints = {});

/// Its nodes with their ends where refined() would have them.
[[nodiscard]] Centerline with_tips(const gate::Candidate& prior, const SecondLook& look,
                                   const Frame& frame, const refine::Network& network,
                                   double rope_length_m, const Hints& hints);

}  // namespace flowdlo::estimator
