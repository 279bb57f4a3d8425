#include "estimator/hypotheses.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "gate/tube_score.hpp"
#include "prior/refined_prior.hpp"

namespace flowdlo::estimator {

namespace {

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

/// What hypotheses of each width are compared with.
class Views {
 public:
  explicit Views(const Frame& frame) : frame_(frame) {}

  gate::TubeView& of(float width_px) {
    for (auto& [width, view] : views_) {
      if (width == width_px) return view;
    }
    return views_.emplace_back(width_px, gate::TubeView(frame_, width_px)).second;
  }

 private:
  const Frame& frame_;
  std::vector<std::pair<float, gate::TubeView>> views_;
};

}  // namespace

Result<std::vector<Hypothesis>> lift_all(const path::Traversals& paths,
                                         const evidence::Cloud& cloud,
                                         const evidence::VisiblePoints& visible, const Frame& frame,
                                         weights::PriorKind kind, threads::Pool* pool) {
  const auto refine = [&](std::size_t i) {
    return prior::refine(paths.ranked[i], width_px(paths, i), cloud, visible, frame);
  };
  Refined known = refined_beforehand(paths, frame, pool, refine);
  Views views(frame);
  Lengths lengths(frame);
  std::vector<Hypothesis> hypotheses;
  double best = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < paths.ranked.size(); ++i) {
    const path::Path& path = paths.ranked[i];
    if (out_of_reach(paths, i) || path.score < best - kSlack || !lengths.allow(paths, i)) continue;
    const auto refined = known[i] ? *std::move(known[i]) : refine(i);
    const bool thesis = kind == weights::PriorKind::kThesis;
    auto lifted = thesis ? prior::lift(path, visible, frame) : refined;  // Eq. (3.1)-(3.7)
    if (!lifted) {
      if (hypotheses.empty()) return lifted.error();
      continue;
    }
    const float drawn_px = width_px(paths, i);
    const Evidence evidence =
        judge(path, drawn_px, refined ? &*refined : nullptr, views.of(drawn_px));
    hypotheses.push_back({.prior = *std::move(lifted),
                          .path = i,
                          .path_score = path.score,
                          .score = rescored(path.score, evidence),
                          .evidence = evidence,
                          .drawn_px = thesis ? 0 : drawn_px});
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
