// Handles: what the C interface's opaque pointers point at.
#pragma once

#include <vector>

#include "c_api/images.hpp"
#include "flowdlo/estimate.hpp"
#include "flowdlo/estimator.hpp"
#include "flowdlo/flowdlo.h"
#include "flowdlo/tracker.hpp"

struct flowdlo_estimator {
  flowdlo::Tracker tracker;
  flowdlo::c_api::Copies copies{};
  std::vector<flowdlo::Alternative> alternatives{};  ///< of the last estimate
  flowdlo::Ropes ropes{};                            ///< of the last one, where it was of several
  std::vector<int> numbers{};                        ///< [ropes] where these were tracked
  std::vector<int> missing{};                        ///< numbers of those that it did not show

  [[nodiscard]] flowdlo::Estimator& estimator() { return *tracker.estimator(); }

  /// What the last estimate left.
  void clear() {
    alternatives.clear();
    ropes = {};
    numbers.clear();
    missing.clear();
  }
};
