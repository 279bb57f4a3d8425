// BrokenPipe: writing to a pipe that nobody reads any more fails, and ends nothing.
#pragma once

#include <csignal>

namespace flowdlo::files {

/// While it lives, SIGPIPE does not reach this thread; one that this thread caused is taken away.
class BrokenPipe {
 public:
  BrokenPipe();
  BrokenPipe(const BrokenPipe&) = delete;
  BrokenPipe& operator=(const BrokenPipe&) = delete;
  ~BrokenPipe();

 private:
  sigset_t before_{};
  bool was_pending_ = false;
};

}  // namespace flowdlo::files
