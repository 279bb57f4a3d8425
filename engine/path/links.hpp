// Links: which ends of strands may be joined, where a rope may end, and at what energy.
#pragma once

#include <limits>
#include <vector>

#include "path/link.hpp"
#include "path/second_opinion.hpp"
#include "path/strands.hpp"

namespace flowdlo::path {

/// A link as the search sees it.
struct Bond {
  int to = -1;     ///< the end that the path enters next
  float cost = 0;  ///< the link's energy
};

/// What a way through strands pays.
struct Prices {
  /// [2 * strands] the bonds of each end, cheapest first; symmetric up to the cut at a few an end.
  std::vector<std::vector<Bond>> bonds;
  std::vector<float> stops;  ///< [2 * strands] energy of a rope's end there
};

/// By heed of another reading's opinion. Where a strand field shows the strands and has a network
/// that links them, that says what each costs; else energy.hpp does, which chooses in any case
/// which few links are asked about, and how they run. Where there may be several ropes, or the
/// only one is known to be a `ring`, a link may lead from one end of a strand to its other one. Of
/// several ropes none leads from one end at the image's border to another: what comes back is
/// another rope.
[[nodiscard]] Prices prices_of(const Strands& strands, const Region& region, const Frame& frame,
                               const Opinion& opinion = {}, bool ring = false);

/// The link between two ends by energy.hpp, whatever it costs. `elsewhere` is kLinkHeard.
[[nodiscard]] Link link_between(int from, int to, const Strands& strands, const Cover& cover,
                                const LinkTerms& weights,
                                float most = std::numeric_limits<float>::max(),
                                float elsewhere = 0);

/// The points of the link between two ends as it is drawn, about a pixel apart, without the ends.
[[nodiscard]] std::vector<Eigen::Vector2f> points_between(int from, int to, const Strands& strands,
                                                          const Cover& cover);

}  // namespace flowdlo::path
