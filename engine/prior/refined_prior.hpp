// Refined prior: the path lifted to the rope's centerline instead of its visible surface.
#pragma once

#include "evidence/visible_points.hpp"
#include "flowdlo/frame.hpp"
#include "flowdlo/result.hpp"
#include "path/path.hpp"
#include "prior/prior.hpp"

namespace flowdlo::prior {

struct RefineConfig {
  LiftConfig lift;  ///< r_px and r_arc of Eq. (3.3): what supports a node
};

/// 64 nodes on the rope's centerline, uniform in arclength in space, canonical direction. Depth
/// comes from every mask pixel with one. `support` is Eq. (3.6) at the nodes' projections; a rope
/// wider than 2 r_px has its half width for r_px. `sigma_m` grows with noise, distance and gaps,
/// more where another strand hides the rope, and towards ends that are covered or outside of the
/// image; of the nodes of right traversals three in four are that near to the rope's, nine in ten
/// twice that. `rope_width_px` is path::Traversals'. Expects a valid frame. Fails with kNoEvidence
/// when no visible point supports any node, with kNoPath when the path has fewer than two points or
/// one that is not finite, with kBadInput when the frame's images do not fit its size.
[[nodiscard]] Result<Prior> refine(const path::Path& path, float rope_width_px,
                                   const evidence::Cloud& cloud,
                                   const evidence::VisiblePoints& visible, const Frame& frame,
                                   const RefineConfig& config = {});

}  // namespace flowdlo::prior
