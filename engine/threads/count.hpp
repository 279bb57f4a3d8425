// Count: how many threads a piece of work gets.
#pragma once

#include <algorithm>
#include <thread>

namespace flowdlo::threads {

/// As many threads as this on any machine: more than a small one has cores, which costs time and
/// nothing else, and lets it run what a larger one runs.
inline constexpr int kFew = 16;

/// Of this machine, or of the part of it that this process may use; at least 1.
[[nodiscard]] inline int cores() {
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

/// `wanted`, or one for each core where that is 0. What is beyond both the cores and kFew would
/// only wait: it is clamped.
[[nodiscard]] inline int count(int wanted) {
  return wanted > 0 ? std::min(wanted, std::max(cores(), kFew)) : cores();
}

}  // namespace flowdlo::threads
