// ChainMerge: chains to one order by the cheapest pairing of their tips, field section 1, point 7.
#pragma once

#include <vector>

#include "baselines/chains.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::baselines {

/// The points of the chains in the order in which the assignment visits them; chains in cycles of
/// their own are lost. Fails with kInternal where a cost is not a number (tips that coincide or
/// are collinear, an arccos beyond 1 by rounding), unless `repaired`; with kNoPath without chains.
[[nodiscard]] Result<Chain> merged(const std::vector<Chain>& chains, bool repaired);

}  // namespace flowdlo::baselines
