// Assemble: a traversal of strands as one smooth polyline in image coordinates.
#pragma once

#include "path/path.hpp"
#include "path/region.hpp"
#include "path/search.hpp"
#include "path/strands.hpp"

namespace flowdlo::path {

/// Points about one pixel apart, consecutive ones distinct; fewer than two when there is nothing.
[[nodiscard]] Path assemble(const Traversal& traversal, const Strands& strands,
                            const Region& region, const Frame& frame);

/// The long axis of the largest component: the answer for a blob that has no skeleton to speak of.
[[nodiscard]] Path long_axis(const Region& region, const Frame& frame);

}  // namespace flowdlo::path
