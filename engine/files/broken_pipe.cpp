#include "files/broken_pipe.hpp"

#include <cerrno>
#include <ctime>

namespace flowdlo::files {
namespace {

sigset_t only_pipe() {
  sigset_t set{};
  sigemptyset(&set);
  sigaddset(&set, SIGPIPE);
  return set;
}

bool is_pending() {
  sigset_t pending{};
  sigpending(&pending);
  return sigismember(&pending, SIGPIPE) == 1;
}

}  // namespace

BrokenPipe::BrokenPipe() {
  const sigset_t set = only_pipe();
  was_pending_ = is_pending();
  pthread_sigmask(SIG_BLOCK, &set, &before_);
}

BrokenPipe::~BrokenPipe() {
  const int code = errno;
  if (!was_pending_ && is_pending()) {
    const sigset_t set = only_pipe();
    const timespec at_once{0, 0};
    while (sigtimedwait(&set, nullptr, &at_once) < 0 && errno == EINTR) {
    }
  }
  pthread_sigmask(SIG_SETMASK, &before_, nullptr);
  errno = code;
}

}  // namespace flowdlo::files
