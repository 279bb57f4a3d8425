// Cost: what one frame takes of the processor and of memory.
#pragma once

#include <string>

#include "flowdlo/estimator.hpp"
#include "flowdlo/frame.hpp"

namespace flowdlo::lab {

struct Cost {
  double cpu_s = 0;    ///< of one call, the least of several
  double peak_mb = 0;  ///< of the process during a call
  std::string
      verdict;  ///< the estimate's confidence, how many ropes, or the error's code and sentence
};

enum class Asked { kOneRope, kSeveralRopes };  ///< estimate(), estimate_ropes()

/// Estimates `frame` that often. Linux only: the peak is the kernel's.
[[nodiscard]] Cost cost_of(const Frame& frame, Estimator& estimator, int rounds,
                           Asked asked = Asked::kOneRope);

}  // namespace flowdlo::lab
