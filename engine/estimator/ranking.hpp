// Ranking: lifted traversals judged by what they would look like, and how sure the best one is.
#pragma once

#include <array>
#include <cstddef>

#include "gate/tube_score.hpp"
#include "path/path.hpp"
#include "prior/prior.hpp"

namespace flowdlo::estimator {

/// What is known about one traversal without any truth.
struct Evidence {
  gate::TubeScore tube;     ///< of the refined prior; the worst where it could not be lifted
  float supported = 0;      ///< [0, 1] share of its nodes with support
  float bridged = 0;        ///< [0, 1] share of the path on links over gaps
  float longest_gap = 0;    ///< [0, 99] in rope widths
  float hidden_ends = 0;    ///< [0, 1] half for each tip where an occluder begins
  float buried_ends = 0;    ///< [0, 1] half for each end on another strand
  bool ring = false;        ///< closed: its ends are a guess
  bool closed = false;      ///< and nothing shows any
  float length_widths = 0;  ///< [0, 999] of the path, in rope widths
};

/// `refined` is null where the traversal could not be lifted.
[[nodiscard]] Evidence judge(const path::Path& path, float rope_width_px,
                             const prior::Prior* refined, gate::TubeView& view);

/// [kPenalties] what speaks against a traversal beside its path score.
inline constexpr std::size_t kPenalties = 6;
[[nodiscard]] std::array<double, kPenalties> penalties(const Evidence& evidence);

/// Path score less the weighed penalties, in units of path::Path::score; higher is better.
[[nodiscard]] double rescored(double path_score, const Evidence& evidence);

/// In [0, 1]: how clear a lead of that much score is.
[[nodiscard]] float margin(double lead);

}  // namespace flowdlo::estimator
