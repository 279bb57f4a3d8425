// Hypotheses: every traversal of the mask lifted to 3D, and which draw is conditioned on which.
#pragma once

#include <vector>

#include "evidence/visible_points.hpp"
#include "flowdlo/frame.hpp"
#include "flowdlo/result.hpp"
#include "path/path.hpp"
#include "prior/prior.hpp"
#include "weights/variant.hpp"

namespace flowdlo::estimator {

/// A traversal and its prior.
struct Hypothesis {
  prior::Prior prior;
  double score = 0;  ///< of the traversal, path::Path::score
};

/// Best first; never empty. Fails as the lift of the best traversal does; runners-up that cannot be
/// lifted are left out.
[[nodiscard]] Result<std::vector<Hypothesis>> lift_all(const path::Traversals& paths,
                                                       const evidence::Cloud& cloud,
                                                       const evidence::VisiblePoints& visible,
                                                       const Frame& frame, weights::PriorKind kind);

/// [draws] index of the hypothesis each draw is conditioned on. A clear winner takes all draws.
/// Below kDoubt of `margin` runners-up get one draw each, from the last draw backwards, and the
/// winner keeps at least half.
[[nodiscard]] std::vector<int> assign_draws(int hypotheses, float margin, int draws);

inline constexpr float kDoubt = 0.5F;  ///< margin below which runners-up are worth a draw

}  // namespace flowdlo::estimator
