// Hypotheses: the traversals of a reading lifted to 3D, and which draw is conditioned on which.
#pragma once

#include <cstddef>
#include <vector>

#include "evidence/visible_points.hpp"
#include "flowdlo/frame.hpp"
#include "flowdlo/result.hpp"
#include "path/path.hpp"
#include "prior/prior.hpp"
#include "threads/pool.hpp"
#include "weights/variant.hpp"

namespace flowdlo::estimator {

/// What a traversal's path is like.
struct Course {
  float bridged = 0;      ///< [0, 1] share of it on links over gaps
  float longest_gap = 0;  ///< [0, 99] in rope widths
  float hidden_ends = 0;  ///< [0, 1] half for each tip where an occluder begins
  float buried_ends = 0;  ///< [0, 1] half for each end on another strand
  bool ring = false;      ///< closed: its ends are a guess
  bool closed = false;    ///< and nothing shows any
};

[[nodiscard]] Course course_of(const path::Path& path, float rope_width_px);

/// A traversal and its prior.
struct Hypothesis {
  prior::Prior prior;    ///< of the kind asked for
  std::size_t path = 0;  ///< index in path::Traversals::ranked of its reading
  double score = 0;      ///< path::Path::score; higher is better
  Course course;
  int reading = 0;      ///< of the frame that brought it forth; 0: the first
  float votes = 0;      ///< [0, 1] share of the readings whose best runs here
  float odds = 0;       ///< [0, 1] mean over the readings of how likely each says it is
  float seen_odds = 0;  ///< [0, 1] how likely the closest look through the field says it is
};

/// In the order of `paths`, best first; never empty. Fails as the lift of the best traversal does;
/// runners-up that cannot be lifted are left out, and so are those that trail by more than kReach,
/// and those beyond the second that would make all of them longer than kMostLiftedSides. `pool`:
/// whose threads lift beside the caller's; null: none. The hypotheses are the same.
[[nodiscard]] Result<std::vector<Hypothesis>> lift_all(const path::Traversals& paths,
                                                       const evidence::Cloud& cloud,
                                                       const evidence::VisiblePoints& visible,
                                                       const Frame& frame, weights::PriorKind kind,
                                                       threads::Pool* pool = nullptr);

/// How far the first hypothesis leads the second, in units of path::Path::score; `kReach` when it
/// is alone.
[[nodiscard]] double lead(const std::vector<Hypothesis>& hypotheses);

/// In [0, 1]: how clear a lead of that much score is.
[[nodiscard]] float margin(double lead);

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

}  // namespace flowdlo::estimator
