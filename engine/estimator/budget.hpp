// Budget: which of a frame's work still ends within the time that the caller gave it.
#pragma once

#include <algorithm>
#include <chrono>

namespace flowdlo::estimator {

/// Begins when it is made.
class Budget {
 public:
  /// 0: no end.
  explicit Budget(double budget_ms) : budget_ms_(budget_ms) {}

  [[nodiscard]] bool bounded() const { return budget_ms_ > 0; }

  /// Whether work that takes so long would end in time.
  [[nodiscard]] bool leaves(double ms) const { return !bounded() || spent_ms() + ms <= budget_ms_; }

  /// A budget of its own, of that share of what is left; no more than a moment where nothing is.
  [[nodiscard]] Budget part(double share) const {
    return Budget(bounded() ? std::max(kMoment_ms, share * (budget_ms_ - spent_ms())) : 0);
  }

 private:
  using Clock = std::chrono::steady_clock;

  static constexpr double kMoment_ms = 1e-6;

  [[nodiscard]] double spent_ms() const {
    return std::chrono::duration<double, std::milli>(Clock::now() - begin_).count();
  }

  double budget_ms_;
  Clock::time_point begin_ = Clock::now();
};

/// What work of one kind takes for each unit of what it depends on. It rises at once with what was
/// slower than expected, and falls slowly: a frame that is late costs more than work left out.
class Cost {
 public:
  /// `unit_ms` is what to expect before anything was seen.
  explicit Cost(double unit_ms) : unit_ms_(unit_ms) {}

  [[nodiscard]] double of(double units) const { return unit_ms_ * units; }

  void saw(double ms, double units);

  /// It was not done: less is expected the next time, so that one slow frame does not keep it out
  /// for good.
  void left_out();

 private:
  double unit_ms_;
};

}  // namespace flowdlo::estimator
