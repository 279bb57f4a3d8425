#include "estimator/hypotheses.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "prior/refined_prior.hpp"

namespace flowdlo::estimator {

namespace {

constexpr double kMarginScore = 3.0;  // the lead that leaves a third of the doubt

float width_px(const path::Traversals& paths, const path::Path& path) {
  return path.width_px > 0 ? path.width_px : paths.rope_width_px;
}

/// [lifted] the indices of the traversals that are lifted, in the order of `paths`. Path points lie
/// a pixel apart.
std::vector<std::size_t> to_lift(const path::Traversals& paths, const Frame& frame) {
  const auto most_px = static_cast<std::size_t>(kMostLiftedSides * (frame.width + frame.height));
  std::size_t lifted_px = 0;
  std::vector<std::size_t> wanted;
  for (std::size_t i = 0; i < paths.ranked.size(); ++i) {
    const path::Path& path = paths.ranked[i];
    if (path.score < paths.ranked.front().score - kReach) continue;
    lifted_px += path.points_px.size();
    if (i <= 1 || lifted_px <= most_px) wanted.push_back(i);
  }
  return wanted;
}

}  // namespace

Course course_of(const path::Path& path, float rope_width_px) {
  const float width_px = std::max(1.0F, rope_width_px);
  float length_px = 0;
  float bridged_px = 0;
  float gap_px = 0;
  float longest_px = 0;
  for (std::size_t i = 1; i < path.points_px.size(); ++i) {
    const float step = (path.points_px[i] - path.points_px[i - 1]).norm();
    const bool bridged = path.bridged[i] != 0 || path.bridged[i - 1] != 0;
    length_px += step;
    gap_px = bridged ? gap_px + step : 0;
    bridged_px += bridged ? step : 0;
    longest_px = std::max(longest_px, gap_px);
  }
  return {.bridged = length_px > 0 ? std::min(1.0F, bridged_px / length_px) : 1,
          .longest_gap = std::min(99.0F, longest_px / width_px),
          .hidden_ends = path.hidden_ends,
          .buried_ends = path.buried_ends,
          .ring = path.ring,
          .closed = path.closed};
}

Result<std::vector<Hypothesis>> lift_all(const path::Traversals& paths,
                                         const evidence::Cloud& cloud,
                                         const evidence::VisiblePoints& visible, const Frame& frame,
                                         weights::PriorKind kind, threads::Pool* pool) {
  const std::vector<std::size_t> wanted = to_lift(paths, frame);
  std::vector<std::optional<Result<prior::Prior>>> lifted(wanted.size());
  threads::share_out(pool, static_cast<int>(wanted.size()), [&](int piece) {
    const auto k = static_cast<std::size_t>(piece);
    const path::Path& path = paths.ranked[wanted[k]];
    lifted[k] = kind == weights::PriorKind::kThesis
                    ? prior::lift(path, visible, frame)  // Eq. (3.1)-(3.7)
                    : prior::refine(path, width_px(paths, path), cloud, visible, frame);
  });
  std::vector<Hypothesis> hypotheses;
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    Result<prior::Prior>& prior = *lifted[k];
    if (!prior) {
      if (hypotheses.empty()) return prior.error();
      continue;
    }
    const path::Path& path = paths.ranked[wanted[k]];
    hypotheses.push_back({.prior = *std::move(prior),
                          .path = wanted[k],
                          .score = path.score,
                          .course = course_of(path, width_px(paths, path))});
  }
  return hypotheses;
}

double lead(const std::vector<Hypothesis>& hypotheses) {
  if (hypotheses.size() < 2) return kReach;
  return std::clamp(hypotheses[0].score - hypotheses[1].score, 0.0, kReach);
}

float margin(double lead) {
  return static_cast<float>(1 - std::exp(-std::max(0.0, lead) / kMarginScore));
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
