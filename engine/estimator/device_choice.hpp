// Which back end a Config asks for, opened.
#pragma once

#include <string>

#include "flow/sampler.hpp"
#include "flowdlo/config.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::estimator {

struct BackEnd {
  std::string name;  ///< "cpu", or the Vulkan device's name
  flow::ProgramFactory make_program;
};

[[nodiscard]] BackEnd cpu_back_end(int threads);

/// Fails with kNoDevice. "auto" never fails: a machine without a GPU that works has a CPU.
[[nodiscard]] Result<BackEnd> choose_back_end(const Config& config);

}  // namespace flowdlo::estimator
