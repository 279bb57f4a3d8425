// Children: programs that are started beside this process and given so long to be done.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace flowdlo::vulkan {

struct Child {
  std::vector<std::string> arguments;    ///< after the program's own name
  std::vector<std::string> environment;  ///< "NAME=value", all that it gets
};

struct Ending {
  enum class Kind {
    kDone,        ///< it said that it was done
    kDied,        ///< it said something, and ended before it was done
    kLate,        ///< it was silent for too long, and was ended
    kNotStarted,  ///< it never got as far as saying anything
  };
  Kind kind = Kind::kNotStarted;
  std::string said;  ///< lines that it wrote to its descriptor 3
  std::string how;   ///< where it died: "SIGSEGV", "exit status 1"; where it did not start: why
};

/// Starts `program` once for each child, all at the same time, and waits until each is done. One
/// that says nothing more for `limit_ms` is ended with all that it started. They have no terminal
/// and none of our files. A child is done when it has written the line "done". Neither handlers of
/// SIGCHLD nor waits of this process's own code for any child disturb the answer.
[[nodiscard]] std::vector<Ending> run_children(const std::filesystem::path& program,
                                               std::span<const Child> children, int limit_ms);

}  // namespace flowdlo::vulkan
