// Link: how a rope may go on from one strand's end to another's, where no line of the strand field
// joins them.
#pragma once

#include <limits>

#include "path/cover.hpp"
#include "path/energy.hpp"
#include "path/strands.hpp"

namespace flowdlo::path {

struct Link {
  LinkTerms terms{};
  float energy = std::numeric_limits<float>::max();
};

/// The cheapest cubic from one end to another; energy from `most` on: none that costs less.
/// `trust` [0, 1] in the directions of both ends; `elsewhere` is kLinkHeard. `cover` sees the
/// field.
[[nodiscard]] Link best_link(const StrandEnd& from, const StrandEnd& to, const Cover& cover,
                             const LinkTerms& weights, float scale_px, float trust,
                             float most = std::numeric_limits<float>::max(), float elsewhere = 0);

/// The least energy of a link so long.
[[nodiscard]] float least_energy(float length_px, const LinkTerms& weights, float scale_px);

}  // namespace flowdlo::path
