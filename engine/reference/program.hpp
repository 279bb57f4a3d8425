// The CPU back end: an ops::Program that runs on this processor's cores.
#pragma once

#include <memory>

#include "ops/program.hpp"

namespace flowdlo::reference {

/// `threads` workers, 0: one a core. The bits of a result do not depend on their number, nor a
/// draw's on how many draws there are: work is cut into blocks of 64 rows whatever runs them.
[[nodiscard]] std::unique_ptr<ops::Program> create_program(int threads);

}  // namespace flowdlo::reference
