// Several: the ropes of one frame, each estimated in a view of its own.
#pragma once

#include <functional>
#include <vector>

#include "estimator/conditions.hpp"
#include "estimator/rope_readings.hpp"
#include "flowdlo/estimate.hpp"
#include "flowdlo/frame.hpp"
#include "flowdlo/hints.hpp"
#include "flowdlo/result.hpp"
#include "gate/calibrated.hpp"
#include "path/path.hpp"

namespace flowdlo::estimator {

/// What telling ropes apart says of one.
struct Part {
  Hints hints{};
  const Traced* traced = nullptr;  ///< its way, where no other is looked for; or null
  gate::InAll in_all{};
};

/// One rope of a frame, within that share, (0, 1], of the time that is left.
using EstimateOne = std::function<Result<Estimate>(const Frame&, const Part&, double share)>;

/// Tells the ropes apart (`part_ropes`, `see` as there) and estimates each by `one`, along the way
/// that was found; one that a label tells apart by all that `one` finds in its view. One rope
/// without labels is `one` of the frame itself. `before` are the ropes of the frame before. A rope
/// that `one` fails of, as one without any depth, is left out as long as another is not. Expects a
/// valid frame. Fails as part_ropes and `one` do.
[[nodiscard]] Result<Ropes> estimate_each(const Frame& frame, int ropes, const EstimateOne& one,
                                          const SeeAxes& see = {},
                                          const std::vector<KnownRope>& before = {});

}  // namespace flowdlo::estimator
