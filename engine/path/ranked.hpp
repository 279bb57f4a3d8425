// Ranked: the ways through a set of strands as paths, best first.
#pragma once

#include <vector>

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

/// [0, 1] Traversals::margin of paths, best first.
[[nodiscard]] float margin_of(const std::vector<Path>& ranked);

}  // namespace flowdlo::path
