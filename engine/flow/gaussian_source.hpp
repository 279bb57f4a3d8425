// Gaussian sources x_0, Sec. 3.5: where each draw's integration begins.
#pragma once

#include <cstdint>
#include <vector>

namespace flowdlo::flow {

/// [draws, 64, 4] standard normal x, y, z, and 0, in normalised space. Draw d depends on (seed, d)
/// alone: the same bits on every back end and for every number of draws.
[[nodiscard]] std::vector<float> gaussian_source(std::uint64_t seed, int draws);

}  // namespace flowdlo::flow
