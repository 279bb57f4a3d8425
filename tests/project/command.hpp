// Command: a program run by the shell, with what it wrote and how it ended.
#pragma once

#include <string>

namespace flowdlo::project {

struct Outcome {
  int status = -1;     ///< exit status; -1: did not start or was killed
  std::string output;  ///< standard output and standard error
};

/// Runs `line` in the project's root.
[[nodiscard]] Outcome run(const std::string& line);

/// True where the shell finds `program`.
[[nodiscard]] bool has_program(const std::string& program);

}  // namespace flowdlo::project
