#include "estimator/hypotheses.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "gate/tube_score.hpp"
#include "prior/refined_prior.hpp"

namespace flowdlo::estimator {

Result<std::vector<Hypothesis>> lift_all(const path::Traversals& paths,
                                         const evidence::Cloud& cloud,
                                         const evidence::VisiblePoints& visible, const Frame& frame,
                                         weights::PriorKind kind) {
  std::vector<std::pair<float, gate::TubeView>> views;  // by the rope's width
  const auto view_of = [&](float width_px) -> gate::TubeView& {
    for (auto& [width, view] : views) {
      if (width == width_px) return view;
    }
    return views.emplace_back(width_px, gate::TubeView(frame, width_px)).second;
  };
  std::vector<Hypothesis> hypotheses;
  double best = -std::numeric_limits<double>::infinity();
  const auto most_px = static_cast<std::size_t>(kMostLiftedSides * (frame.width + frame.height));
  std::size_t lifted_px = 0;  // path points lie a pixel apart
  for (std::size_t i = 0; i < paths.ranked.size(); ++i) {
    const path::Path& path = paths.ranked[i];
    if (path.score < paths.ranked.front().score - kReach || path.score < best - kSlack) continue;
    lifted_px += path.points_px.size();
    if (i > 1 && lifted_px > most_px) continue;
    const float width_px = path.width_px > 0 ? path.width_px : paths.rope_width_px;
    const auto refined = prior::refine(path, width_px, cloud, visible, frame);
    auto lifted = kind == weights::PriorKind::kThesis
                      ? prior::lift(path, visible, frame)  // Eq. (3.1)-(3.7)
                      : refined;
    if (!lifted) {
      if (hypotheses.empty()) return lifted.error();
      continue;
    }
    const Evidence evidence =
        judge(path, width_px, refined ? &*refined : nullptr, view_of(width_px));
    hypotheses.push_back(
        {*std::move(lifted), i, path.score, rescored(path.score, evidence), evidence});
    best = std::max(best, hypotheses.back().score);
  }
  std::stable_sort(hypotheses.begin(), hypotheses.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.score > b.score; });
  return hypotheses;
}

double lead(const std::vector<Hypothesis>& hypotheses) {
  if (hypotheses.size() < 2) return kReach;
  return std::clamp(hypotheses[0].score - hypotheses[1].score, 0.0, kReach);
}

std::vector<int> assign_draws(int hypotheses, float margin, int draws) {
  std::vector<int> assigned(static_cast<std::size_t>(draws), 0);
  if (margin >= kDoubt) return assigned;
  const int runners_up = std::min(hypotheses - 1, draws / 2);
  for (int i = 1; i <= runners_up; ++i) assigned[static_cast<std::size_t>(draws - i)] = i;
  return assigned;
}

std::vector<int> spread_draws(int hypotheses, int draws) {
  std::vector<int> assigned(static_cast<std::size_t>(draws), 0);
  for (int i = 1; i < std::min(hypotheses, draws); ++i) {
    assigned[static_cast<std::size_t>(draws - i)] = i;
  }
  return assigned;
}

}  // namespace flowdlo::estimator
