#include "project/command.hpp"

#include <sys/wait.h>

#include <array>
#include <cstdio>

#include "support/source_dir.hpp"

namespace flowdlo::project {

bool has_program(const std::string& program) { return run("command -v " + program).status == 0; }

Outcome run(const std::string& line) {
  const std::string in_root = "cd '" + test::source_dir().string() + "' && { " + line + "; } 2>&1";
  FILE* pipe = popen(in_root.c_str(), "r");
  if (pipe == nullptr) {
    return {};
  }
  Outcome outcome;
  std::array<char, 4096> block{};
  while (const auto count = std::fread(block.data(), 1, block.size(), pipe)) {
    outcome.output.append(block.data(), count);
  }
  const int status = pclose(pipe);
  outcome.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  return outcome;
}

}  // namespace flowdlo::project
