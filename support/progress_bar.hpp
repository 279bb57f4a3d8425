// ProgressBar: one line on a terminal for what takes longer than two seconds.
#pragma once

#include <chrono>
#include <string>

namespace flowdlo::support {

/// Writes to stderr, and only when that is a terminal and `quiet` is false. Erases itself.
class ProgressBar {
 public:
  ProgressBar(std::string label, int total, bool quiet);
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;
  ~ProgressBar();

  /// One more is done.
  void advance();
  /// Makes room for a line of other output; the next advance() draws the bar again.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  std::string label_;
  int total_;
  int done_ = 0;
  bool enabled_;
  bool drawn_ = false;
  Clock::time_point start_ = Clock::now();
};

}  // namespace flowdlo::support
