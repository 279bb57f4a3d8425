// ThreadLimit: while it lives only so many more threads can be started, as under a limit on
// processes. Its source must be part of the test's own executable, whose pthread_create comes
// first.
#pragma once

namespace flowdlo::testing {

class ThreadLimit {
 public:
  explicit ThreadLimit(int more);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

  /// How often a thread was refused.
  [[nodiscard]] int refused() const;
};

}  // namespace flowdlo::testing
