// One program with every operation of ops::Program, in several stages.
#pragma once

#include "vulkan/trial.hpp"

namespace flowdlo::vulkan::testing {

/// Records all of it on inputs of a small frame.
void record_every_op(Trial& trial);

}  // namespace flowdlo::vulkan::testing
