// The CPU back end: an ops::Program that runs on this processor's cores.
#pragma once

#include <memory>

#include "ops/program.hpp"
#include "reference/kernels.hpp"

namespace flowdlo::reference {

/// `threads` workers, 0: one a core. The bits of a result do not depend on their number, nor a
/// draw's on how many draws there are: every row is summed in the same order whoever does it.
/// run() allocates nothing.
[[nodiscard]] std::unique_ptr<ops::Program> create_program(int threads);

/// The same with kernels of one's choice, for tests and benchmarks.
[[nodiscard]] std::unique_ptr<ops::Program> create_program(int threads, const Kernels& kernels);

}  // namespace flowdlo::reference
