// Links: which ends of the strands that a field shows may be joined, and at what energy.
#pragma once

#include <vector>

#include "path/bonds.hpp"
#include "path/link.hpp"
#include "path/second_opinion.hpp"

namespace flowdlo::path {

/// [2 * strands] the links of each end, cheapest first; symmetric up to the cut at a few an end.
/// For `several` ropes a link may lead from one end of a strand to its other one, for there may be
/// rings, but none from one end at the image's border to another: what comes back is another rope.
[[nodiscard]] std::vector<std::vector<Bond>> make_links(const Strands& strands,
                                                        const Region& region, const Frame& frame,
                                                        bool several = false,
                                                        const Opinion& opinion = {});

/// The link between two ends, whatever it costs: what the weights are fitted to. `elsewhere` is
/// kLinkHeard.
[[nodiscard]] Link link_between(int from, int to, const Strands& strands, const Cover& cover,
                                const LinkTerms& weights,
                                float most = std::numeric_limits<float>::max(),
                                float elsewhere = 0);

/// What a path pays that ends there, and what that comes of.
[[nodiscard]] StopTerms stop_terms(const StrandEnd& end);

}  // namespace flowdlo::path
