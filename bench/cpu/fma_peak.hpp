// What one core can do at most: multiply-adds on registers alone, as wide as the kernels'.
#pragma once

#include <string_view>

namespace flowdlo::bench {

/// GFLOP/s of this core just now, the best of several tries; 0 where it is not known how to measure
/// the instruction set.
[[nodiscard]] double fma_peak_gflops(std::string_view isa);

}  // namespace flowdlo::bench
