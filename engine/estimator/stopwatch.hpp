// Stopwatch: the milliseconds of one stage after another.
#pragma once

#include <chrono>

namespace flowdlo::estimator {

/// Adds the time since the last lap to one of the caller's figures.
class Stopwatch {
 public:
  void lap(double& total_ms) {
    const auto now = Clock::now();
    total_ms += std::chrono::duration<double, std::milli>(now - last_).count();
    last_ = now;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_ = Clock::now();
};

}  // namespace flowdlo::estimator
