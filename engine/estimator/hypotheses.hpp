// Hypotheses: the traversals of the mask lifted to 3D, in the order in which they explain the
// frame, and which draw is conditioned on which.
#pragma once

#include <cstddef>
#include <vector>

#include "estimator/ranking.hpp"
#include "evidence/visible_points.hpp"
#include "flowdlo/frame.hpp"
#include "flowdlo/result.hpp"
#include "path/path.hpp"
#include "prior/prior.hpp"
#include "threads/pool.hpp"
#include "weights/variant.hpp"

namespace flowdlo::estimator {

/// A traversal, its prior, and how well it explains the frame.
struct Hypothesis {
  prior::Prior prior;     ///< of the kind asked for
  std::size_t path = 0;   ///< index in path::Traversals::ranked of its reading
  double path_score = 0;  ///< path::Path::score
  double score = 0;       ///< after comparing with mask and depth, `rescored`
  Evidence evidence;      ///< of the refined prior, whatever kind `prior` is
  float drawn_px = 0;     ///< the rope's width in evidence.tube where that is of `prior`; else 0
  int reading = 0;        ///< of the mask that brought it forth; 0: as given
  float votes = 0;        ///< [0, 1] share of the readings whose best runs here
  float odds = 0;         ///< [0, 1] mean over the readings of how likely each says it is
  float seen_odds = 0;    ///< [0, 1] how likely the closest look through the field says it is
};

/// Best `score` first, ties in the order of `paths`; never empty. Fails as the lift of the best
/// traversal does; runners-up that cannot be lifted are left out, and so are those whose path
/// score is so low (kReach, kSlack) that no comparison would bring them near the front, and those
/// beyond the second that would make all of them longer than kMostLiftedSides. `pool`: whose
/// threads lift beside the caller's; null: none. The hypotheses are the same.
[[nodiscard]] Result<std::vector<Hypothesis>> lift_all(const path::Traversals& paths,
                                                       const evidence::Cloud& cloud,
                                                       const evidence::VisiblePoints& visible,
                                                       const Frame& frame, weights::PriorKind kind,
                                                       threads::Pool* pool = nullptr);

/// How far the first hypothesis leads the second, in units of path::Path::score; `kReach` when it
/// is alone.
[[nodiscard]] double lead(const std::vector<Hypothesis>& hypotheses);

/// [draws] index of the hypothesis each draw is conditioned on. A clear winner takes all draws.
/// Below kDoubt of `margin` runners-up get one draw each, from the last draw backwards, and the
/// winner keeps at least half.
[[nodiscard]] std::vector<int> assign_draws(int hypotheses, float margin, int draws);

/// [draws] the same for a gate that can tell them apart: every hypothesis gets a draw, best first,
/// as long as there are draws; those left over go to the winner.
[[nodiscard]] std::vector<int> spread_draws(int hypotheses, int draws);

/// Length of all traversals that are lifted, in sums of the image's two sides: as long as the
/// strokes of a mask may be. Over a hundred `wide` scenes the longest of one is 1.8.
inline constexpr int kMostLiftedSides = 8;

inline constexpr float kDoubt = 0.5F;  ///< margin below which runners-up are worth a draw
inline constexpr double kReach = 6;    ///< path score by which a runner-up may trail the first
inline constexpr double kSlack = 1;    ///< and by which it may miss the best score so far

}  // namespace flowdlo::estimator
