// E_t(t_k), Eq. (3.13): the time token of each Euler step. It depends on the weights and on K
// alone, so it is computed once, in double precision, when a sampler is made.
#pragma once

#include <vector>

#include "weights/weights.hpp"

namespace flowdlo::flow {

/// [steps, 256] tokens at t_k = k / steps, Eq. (3.26).
[[nodiscard]] std::vector<float> time_tokens(const weights::Weights& weights, int steps);

}  // namespace flowdlo::flow
