// Ranked: the ways through a set of strands as paths, best first.
#pragma once

#include "flowdlo/frame.hpp"
#include "flowdlo/result.hpp"
#include "path/path.hpp"
#include "path/region.hpp"
#include "path/strands.hpp"

namespace flowdlo::path {

/// As `trace`, of strands that are known; places are those of the frame that `region` was cut out
/// of. Where no strand gives a path, the long axis of the region does. Fails with kNoPath where
/// that is a spot.
[[nodiscard]] Result<Traversals> rank(const Strands& strands, const Region& region,
                                      const Frame& frame, const TraceConfig& config);

}  // namespace flowdlo::path
