// Eroded: the mask read once more without its border. What hangs together by a pixel parts, and
// where the rest agrees with the mask as it is, both are right more often than either.
#pragma once

#include "flowdlo/frame.hpp"
#include "flowdlo/result.hpp"
#include "path/path.hpp"

namespace flowdlo::path {

/// As `trace`, of the mask without a sixteenth of the rope's width from each side, one pixel at
/// least; widths are those of the mask as it is. Expects a valid frame. Fails with kNoPath where
/// nothing is left of the mask.
[[nodiscard]] Result<Traversals> trace_eroded(const Frame& frame, float rope_width_px,
                                              const TraceConfig& config = {});

}  // namespace flowdlo::path
