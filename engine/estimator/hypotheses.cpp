#include "estimator/hypotheses.hpp"

#include <algorithm>

#include "prior/refined_prior.hpp"

namespace flowdlo::estimator {

Result<std::vector<Hypothesis>> lift_all(const path::Traversals& paths,
                                         const evidence::Cloud& cloud,
                                         const evidence::VisiblePoints& visible, const Frame& frame,
                                         weights::PriorKind kind) {
  std::vector<Hypothesis> hypotheses;
  for (const path::Path& path : paths.ranked) {
    auto lifted = kind == weights::PriorKind::kThesis
                      ? prior::lift(path, visible, frame)  // Eq. (3.1)-(3.7)
                      : prior::refine(path, paths.rope_width_px, cloud, visible, frame);
    if (lifted) {
      hypotheses.push_back({*std::move(lifted), path.score});
    } else if (hypotheses.empty()) {
      return lifted.error();
    }
  }
  return hypotheses;
}

std::vector<int> assign_draws(int hypotheses, float margin, int draws) {
  std::vector<int> assigned(static_cast<std::size_t>(draws), 0);
  if (margin >= kDoubt) return assigned;
  const int runners_up = std::min(hypotheses - 1, draws / 2);
  for (int i = 1; i <= runners_up; ++i) assigned[static_cast<std::size_t>(draws - i)] = i;
  return assigned;
}

}  // namespace flowdlo::estimator
