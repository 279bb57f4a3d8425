// Draws: what every draw of one estimate contributes to a trial.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "eval/trial.hpp"
#include "flowdlo/estimate.hpp"

namespace flowdlo::eval {

/// [64, 3] floats as a centerline.
[[nodiscard]] Centerline centerline_of(std::span<const float> values);

/// Curves are kept to the hundredth of a millimetre, so that files of them stay small.
inline constexpr double kCurveUnit_m = 1e-5;
[[nodiscard]] Centerline kept(const Centerline& nodes);

/// Accounts and curves of `method`'s draws ("model" where it is empty), and the account of the
/// prior they were judged against (METHOD.prior, or "prior"). A method with steps in its name
/// ("full@4") keeps no curves.
void add_draws(const Estimate& estimate, const Tensors& tensors, const std::string& method,
               Trial& trial);

/// Errors: of the draws (METHOD, or "model"), of what the gate makes of each (METHOD.hybrid), and
/// of the best of draws and prior (METHOD.oracle). Sec. 4.4.4.
void add_draw_scores(const Estimate& estimate, const Tensors& tensors, const Centerline& truth,
                     const std::string& method, Trial& trial);

}  // namespace flowdlo::eval
