// ConfigCheck: a configuration before anything is opened with it.
#pragma once

#include "flowdlo/config.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::estimator {

/// Fails with kBadInput, all fields that are out of range at once.
[[nodiscard]] Result<void> check(const Config& config);

}  // namespace flowdlo::estimator
