// Crew: a fixed number of threads that work on one thing together, and meet at barriers.
#pragma once

#include <sys/types.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>
#include <type_traits>
#include <vector>

namespace flowdlo::reference {

/// Threads live as long as the crew and sleep between calls. Nothing is allocated after
/// construction.
class Crew {
 public:
  /// threads::count(threads) with the caller's own, or as many as can be started.
  explicit Crew(int threads);
  /// In a process that was forked from the crew's own there are no threads to wait for.
  ~Crew();
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  [[nodiscard]] int size() const { return size_; }

  /// work(thread) on every thread, 0 being the caller; returns when all are done. Not reentrant,
  /// and the work must throw nothing: the others would wait for it at a barrier for ever.
  template <class Work>
  void run(const Work& work) {
    run({&work, [](const void* which, int thread) { (*static_cast<const Work*>(which))(thread); }});
  }

  /// Called by every thread within run(): returns when all have called it.
  void meet();

 private:
  struct Job {
    const void* work = nullptr;
    void (*call)(const void* work, int thread) = nullptr;
  };

  void run(const Job& job);
  void serve(int thread);

  const pid_t process_;  // whose threads they are
  std::unique_ptr<std::vector<std::thread>> workers_;
  int size_ = 1;
  Job job_;                              // no work: the workers end
  std::atomic<std::uint32_t> round_{0};  // of run(): its change starts the workers
  std::atomic<std::uint32_t> phase_{0};  // of meet(): its change lets everyone go on
  std::atomic<int> missing_{0};          // at the barrier
};

}  // namespace flowdlo::reference
