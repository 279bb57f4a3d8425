// Rope paths: the cheapest set of ropes through strands, each as one path.
#pragma once

#include <vector>

#include "flowdlo/frame.hpp"
#include "flowdlo/result.hpp"
#include "path/links.hpp"
#include "path/path.hpp"
#include "path/region.hpp"
#include "path/strands.hpp"

namespace flowdlo::path {

/// What is known of a frame's ropes beside the frame.
struct Beside {
  int number = 0;              ///< of them; 0: unknown
  std::vector<Path> before{};  ///< those of the frame before, in this one's pixels
};

/// As `trace_ropes`, of strands and prices that are known; places are those of the
/// frame that `region` was cut out of.
[[nodiscard]] Result<RopePaths> rope_paths(const Strands& strands, const Prices& prices,
                                           const Region& region, const Frame& frame,
                                           const Beside& beside);

}  // namespace flowdlo::path
