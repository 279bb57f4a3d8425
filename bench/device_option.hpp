// Options of the form --NAME=VALUE of the programs here that Google Benchmark leaves theirs.
#pragma once

#include <string>

namespace flowdlo::bench {

/// What follows `name` ("--device=") in the last argument that begins with it; empty without one.
[[nodiscard]] inline std::string option(int argc, char** argv, const std::string& name) {
  std::string value;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument.rfind(name, 0) == 0) value = argument.substr(name.size());
  }
  return value;
}

/// NAME of the last such argument; "vulkan" without one.
[[nodiscard]] inline std::string wanted_device(int argc, char** argv) {
  const std::string wanted = option(argc, argv, "--device=");
  return wanted.empty() ? "vulkan" : wanted;
}

}  // namespace flowdlo::bench
