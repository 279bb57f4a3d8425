#include "estimator/budget.hpp"

namespace flowdlo::estimator {
namespace {

constexpr double kFalls = 0.1;     // of the way to what is seen, where that is less than expected
constexpr double kForgets = 0.02;  // of what is expected, each time that it is not done

}  // namespace

void Cost::saw(double ms, double units) {
  if (!(units > 0)) return;
  const double seen_ms = ms / units;
  unit_ms_ = seen_ms > unit_ms_ ? seen_ms : unit_ms_ + kFalls * (seen_ms - unit_ms_);
}

void Cost::left_out() { unit_ms_ *= 1 - kForgets; }

}  // namespace flowdlo::estimator
