// Stayed: the rope where it was in the frame before, as one more hypothesis of this frame.
#pragma once

#include <optional>

#include "estimator/conditions.hpp"
#include "estimator/hypotheses.hpp"
#include "flowdlo/centerline.hpp"
#include "flowdlo/frame.hpp"

namespace flowdlo::estimator {

/// `previous` as it is, in the direction of the other hypotheses, with the support and sigma that
/// this frame gives its projection. What readings of the mask say of it is what they say of the
/// nearest of `known`, if that lies within kSameWay of the rope's length: the same way through the
/// mask. None where this frame does not back it at all, or where there is no
/// previous that can be seen.
[[nodiscard]] std::optional<Hypothesis> stayed(const std::optional<Centerline>& previous,
                                               const std::vector<Hypothesis>& known,
                                               const Conditions& conditions, const Frame& frame);

inline constexpr double kSameWay = 0.05;

}  // namespace flowdlo::estimator
