// A known-answer test of a back end: drivers that return wrong numbers exist, and a robot must not
// find out by its motions.
#pragma once

#include <string>

#include "flow/sampler.hpp"

namespace flowdlo::estimator {

struct Verdict {
  bool passed = false;
  std::string text;  ///< one sentence, with the largest difference seen
};

/// Runs a small seeded model (every kernel, two steps, one draw) on `device` and on the CPU back
/// end and compares the predictions; then a small strand field's network. Passes within 0.1 mm,
/// when the visible points agree bit for bit, and when the network's values do as
/// FieldTrial::agrees has it.
[[nodiscard]] Verdict self_test(const flow::ProgramFactory& device);

}  // namespace flowdlo::estimator
