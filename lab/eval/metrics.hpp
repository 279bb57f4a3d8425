// Metrics: an estimated centerline against the true one, Sec. 4.1.4. Metres, camera frame.
#pragma once

#include "flowdlo/centerline.hpp"

namespace flowdlo::eval {

/// Mean distance of nodes of equal index, Eq. (4.1).
[[nodiscard]] double index_error_m(const Centerline& nodes, const Centerline& truth);

/// Discrete Frechet distance, Eq. (4.2).
[[nodiscard]] double frechet_m(const Centerline& nodes, const Centerline& truth);

/// Share of nodes, in [0, 1], whose nearest true node lies more than a tenth of the rope's length
/// away along the rope: they are on the wrong strand, or in the wrong order.
[[nodiscard]] double strand_errors(const Centerline& nodes, const Centerline& truth);

[[nodiscard]] Centerline reversed(const Centerline& nodes);

/// `nodes` from the end that Sec. 3.3 puts first: smaller x, then y, then z.
[[nodiscard]] Centerline canonical(const Centerline& nodes);

/// One centerline's figures. All but `flipped`, `either_index_m` and `strand_errors` compare in the
/// direction in which both are published, as the thesis does for its own estimator.
struct Score {
  double index_m = 0;
  double frechet_m = 0;
  double either_index_m = 0;  ///< Eq. (4.3): in the better direction
  double strand_errors = 0;   ///< in the better direction
  bool flipped = false;       ///< the other direction is the better one
};

/// `truth` may run either way; `nodes` count as published.
[[nodiscard]] Score score(const Centerline& nodes, const Centerline& truth);

/// `truth` in the direction in which the nodes of that score compare best with it.
[[nodiscard]] Centerline turned(const Centerline& truth, const Score& score);

}  // namespace flowdlo::eval
