// Handles: what the C interface's opaque pointers point at.
#pragma once

#include <vector>

#include "c_api/images.hpp"
#include "flowdlo/estimator.hpp"
#include "flowdlo/flowdlo.h"

struct flowdlo_estimator {
  flowdlo::Estimator estimator;
  flowdlo::c_api::Copies copies;
  std::vector<flowdlo::Alternative> alternatives;  ///< of the last estimate
  flowdlo::Ropes ropes;                            ///< of the last one, where it was of several

  void forget() {
    alternatives.clear();
    ropes = {};
  }
};
