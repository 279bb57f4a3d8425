// Conditions: what one frame says before any model is asked, Eq. (3.11). The estimator and the
// trainer both take it from here, so that a model sees in use what it saw in training.
#pragma once

#include <vector>

#include "estimator/hypotheses.hpp"
#include "evidence/visible_points.hpp"
#include "flowdlo/estimate.hpp"
#include "flowdlo/frame.hpp"
#include "flowdlo/result.hpp"
#include "path/path.hpp"
#include "weights/variant.hpp"

namespace flowdlo::estimator {

struct Conditions {
  evidence::Cloud cloud;
  evidence::VisiblePoints visible;
  path::Traversals paths;
  std::vector<Hypothesis> hypotheses;  ///< best first; never empty
};

/// `rope_length_m` 0: unknown; `ends` as path::TraceConfig's. `traced`: the paths, where they are
/// known already; else null. Fills evidence_ms, path_ms and prior_ms of `timings`. Expects a valid
/// frame. Fails with kNoEvidence, or as path::trace and lift_all do.
[[nodiscard]] Result<Conditions> gather(const Frame& frame, double rope_length_m,
                                        weights::PriorKind kind, Timings& timings,
                                        const std::vector<Eigen::Vector2f>& ends = {},
                                        const path::Traversals* traced = nullptr);

}  // namespace flowdlo::estimator
