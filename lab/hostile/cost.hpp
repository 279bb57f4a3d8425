// Cost: what a frame takes of the processor and of memory, beside an ordinary frame of its size.
#pragma once

#include <string>

#include "flowdlo/estimator.hpp"
#include "flowdlo/frame.hpp"

namespace flowdlo::lab {

struct Cost {
  double cpu_s = 0;           ///< of one call, the least of several
  double ordinary_cpu_s = 0;  ///< of the ordinary frame between those calls
  double peak_mb = 0;         ///< of the process during a call, the caller's frame left out
  std::string verdict;        ///< confidence, or the error's code and sentence

  /// How many times what an ordinary frame takes.
  [[nodiscard]] double ratio() const { return ordinary_cpu_s > 0 ? cpu_s / ordinary_cpu_s : 0; }
};

/// Estimates both frames by turns, `rounds` times each after one call each that is not counted.
/// Linux only: the peak is the kernel's.
[[nodiscard]] Cost cost_of(const Frame& frame, const Frame& ordinary, Estimator& estimator,
                           int rounds);

}  // namespace flowdlo::lab
