// StrandReading: the mask read through a strand field, in which strands that the mask merges lie
// apart.
#pragma once

#include "field/strand_field.hpp"
#include "flowdlo/frame.hpp"
#include "flowdlo/result.hpp"
#include "path/path.hpp"

namespace flowdlo::path {

/// As `trace`, of the axes that `seen` shows. Expects a valid frame and what a network saw of it.
/// Fails with kNoPath as `trace` does.
[[nodiscard]] Result<Traversals> trace_strands(const Frame& frame, const field::StrandField& seen,
                                               const TraceConfig& config = {});

}  // namespace flowdlo::path
