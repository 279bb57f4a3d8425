// StrandReading: the mask read through a strand field, in which strands that the mask merges lie
// apart.
#pragma once

#include <vector>

#include "field/axes.hpp"
#include "flowdlo/frame.hpp"
#include "flowdlo/result.hpp"
#include "path/path.hpp"
#include "path/second_opinion.hpp"
#include "path/strands.hpp"

namespace flowdlo::path {

/// As `trace`, of the axes that a network sees in the frame. Expects a valid frame. Fails with
/// kNoPath as `trace` does.
[[nodiscard]] Result<Traversals> trace_strands(const Frame& frame, const field::Axes& axes,
                                               const TraceConfig& config = {});

/// The strands that a network sees in `frame`, cleaned into `region`, of one rope or, perhaps, of
/// several; borrows `axes`.
[[nodiscard]] Strands strands_of(const Frame& frame, const field::Axes& axes, const Region& region,
                                 bool several = false);

/// As `trace_ropes`, of the axes that a network sees in the frame; ropes rather go on where those
/// `guesses` do that other readings of the frame gave.
[[nodiscard]] Result<RopePaths> trace_ropes(const Frame& frame, const field::Axes& axes, int ropes,
                                            const std::vector<RopesGuess>& guesses = {},
                                            const std::vector<Path>& before = {});

}  // namespace flowdlo::path
