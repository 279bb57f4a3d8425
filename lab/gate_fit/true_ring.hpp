// TrueRing: a ring begins nowhere, so that its true nodes have to be told as an estimate's are.
#pragma once

#include "flowdlo/centerline.hpp"

namespace flowdlo::lab {

/// The true nodes of a closed rope, evenly spaced and node 63 next to node 0, from where they are
/// nearest to `found`, whichever way round that runs.
[[nodiscard]] Centerline true_ring(const Centerline& ring, const Centerline& found);

}  // namespace flowdlo::lab
