// Refinement: a hypothesis with its nodes where the refining networks see the rope's axis and tips.
#pragma once

#include "estimator/second_look.hpp"
#include "flowdlo/frame.hpp"
#include "flowdlo/result.hpp"
#include "gate/candidate.hpp"
#include "refine/network.hpp"
#include "refine/refined.hpp"
#include "refine/strip.hpp"

namespace flowdlo::estimator {

/// A candidate as the refining networks are told about it.
[[nodiscard]] refine::Curve curve_of(const gate::Candidate& candidate);

/// As refine::refined() of a prior of this frame: the networks have seen no other. Its ends stay
/// where they are `known`, where the rope is a ring, and where `look` has no strand field.
[[nodiscard]] Result<refine::Refined> refined(const gate::Candidate& prior, const SecondLook& look,
                                              const Frame& frame, refine::Network& network,
                                              bool ends_known = false);

}  // namespace flowdlo::estimator
