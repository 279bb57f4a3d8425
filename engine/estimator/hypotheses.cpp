#include "estimator/hypotheses.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "prior/refined_prior.hpp"

namespace flowdlo::estimator {

namespace {

constexpr double kMarginScore = 3.0;  // the lead that leaves a third of the doubt

float width_px(const path::Traversals& paths, std::size_t i) {
  return paths.ranked[i].width_px > 0 ? paths.ranked[i].width_px : paths.rope_width_px;
}

bool out_of_reach(const path::Traversals& paths, std::size_t i) {
  return paths.ranked[i].score < paths.ranked.front().score - kReach;
}

/// Counts what is lifted against kMostLiftedSides; path points lie a pixel apart.
class Lengths {
 public:
  explicit Lengths(const Frame& frame)
      : most_px_(static_cast<std::size_t>(kMostLiftedSides * (frame.width + frame.height))) {}

  /// Whether traversal `i` is still to be lifted.
  bool allow(const path::Traversals& paths, std::size_t i) {
    lifted_px_ += paths.ranked[i].points_px.size();
    return i <= 1 || lifted_px_ <= most_px_;
  }

 private:
  std::size_t most_px_;
  std::size_t lifted_px_ = 0;
};

/// [ranked] the refined priors of all that will most likely be asked for, where threads can make
/// them at the same time; nothing elsewhere.
using Refined = std::vector<std::optional<Result<prior::Prior>>>;

template <class Refine>
Refined refined_beforehand(const path::Traversals& paths, const Frame& frame, threads::Pool* pool,
                           const Refine& refine) {
  Refined refined(paths.ranked.size());
  if (pool == nullptr || pool->threads() < 2) return refined;
  std::vector<std::size_t> wanted;
  Lengths lengths(frame);
  for (std::size_t i = 0; i < paths.ranked.size(); ++i) {
    if (!out_of_reach(paths, i) && lengths.allow(paths, i)) wanted.push_back(i);
  }
  threads::share_out(pool, static_cast<int>(wanted.size()), [&](int piece) {
    const std::size_t i = wanted[static_cast<std::size_t>(piece)];
    refined[i] = refine(i);
  });
  return refined;
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
  const auto refine = [&](std::size_t i) {
    return prior::refine(paths.ranked[i], width_px(paths, i), cloud, visible, frame);
  };
  const bool thesis = kind == weights::PriorKind::kThesis;
  Refined known = refined_beforehand(paths, frame, thesis ? nullptr : pool, refine);
  Lengths lengths(frame);
  std::vector<Hypothesis> hypotheses;
  for (std::size_t i = 0; i < paths.ranked.size(); ++i) {
    const path::Path& path = paths.ranked[i];
    if (out_of_reach(paths, i) || !lengths.allow(paths, i)) continue;
    auto lifted = thesis     ? prior::lift(path, visible, frame)  // Eq. (3.1)-(3.7)
                  : known[i] ? *std::move(known[i])
                             : refine(i);
    if (!lifted) {
      if (hypotheses.empty()) return lifted.error();
      continue;
    }
    hypotheses.push_back({.prior = *std::move(lifted),
                          .path = i,
                          .score = path.score,
                          .course = course_of(path, width_px(paths, i))});
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
