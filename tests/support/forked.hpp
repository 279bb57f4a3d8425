// Forked: something done in a child of this process.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

namespace flowdlo::testing {

/// What `work` gives in a process forked from here, 0 to 99; -1 where it did not end by itself: it
/// was aborted, or hung for a minute.
template <class Work>
int forked(const Work& work) {
  constexpr unsigned kPatience_s = 60;
  const pid_t child = ::fork();
  if (child == 0) {
    ::alarm(kPatience_s);
    ::_exit(work());
  }
  int status = 0;
  if (child < 0 || ::waitpid(child, &status, 0) != child) return -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace flowdlo::testing
