// Turns: ways to do one thing, timed one after another (A B C A B C), so that a busy minute of the
// machine falls on all of them.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <ctime>
#include <functional>
#include <thread>
#include <vector>

namespace flowdlo::peers {

struct Turn {
  double wall_ms = 0;
  double cpu_ms = 0;  ///< of all threads together
};

[[nodiscard]] inline double cpu_ms() {
  timespec time{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

/// Every one of `ways` once to warm up and `rounds` times more, by way.
[[nodiscard]] inline std::vector<std::vector<Turn>> time_in_turns(
    const std::vector<std::function<void()>>& ways, int rounds) {
  // Between turns: idle threads of a BLAS or of ONNX Runtime spin before they sleep.
  constexpr std::chrono::milliseconds kPause{150};
  std::vector<std::vector<Turn>> turns(ways.size());
  for (int round = 0; round <= rounds; ++round) {
    for (std::size_t i = 0; i < ways.size(); ++i) {
      std::this_thread::sleep_for(kPause);
      const double cpu_start = cpu_ms();
      const auto start = std::chrono::steady_clock::now();
      ways[i]();
      const std::chrono::duration<double, std::milli> took =
          std::chrono::steady_clock::now() - start;
      if (round > 0) turns[i].push_back({took.count(), cpu_ms() - cpu_start});
    }
  }
  return turns;
}

/// Between the values beside `share` of them.
[[nodiscard]] inline double percentile(const std::vector<Turn>& turns, double Turn::*field,
                                       double share) {
  std::vector<double> values;
  for (const Turn& turn : turns) values.push_back(turn.*field);
  std::sort(values.begin(), values.end());
  const double rank = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(rank);
  const auto above = std::min(below + 1, values.size() - 1);
  return values[below] + (rank - static_cast<double>(below)) * (values[above] - values[below]);
}

}  // namespace flowdlo::peers
