// The option --device=NAME of the programs here that Google Benchmark leaves theirs.
#pragma once

#include <string>

namespace flowdlo::bench {

/// NAME of the last such argument; "vulkan" without one.
[[nodiscard]] inline std::string wanted_device(int argc, char** argv) {
  std::string wanted = "vulkan";
  const std::string option = "--device=";
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument.rfind(option, 0) == 0) wanted = argument.substr(option.size());
  }
  return wanted;
}

}  // namespace flowdlo::bench
