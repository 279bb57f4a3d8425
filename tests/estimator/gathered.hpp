// Gathered: the conditions of a frame, for tests of what comes after them.
#pragma once

#include <stdexcept>

#include "estimator/conditions.hpp"

namespace flowdlo::testing {

/// Throws where there are none: a test without them shows nothing.
inline estimator::Conditions gathered(const Frame& frame) {
  Timings timings;
  auto conditions = estimator::gather(frame, {}, timings);
  if (!conditions) throw std::runtime_error(conditions.error().message);
  return *std::move(conditions);
}

}  // namespace flowdlo::testing
