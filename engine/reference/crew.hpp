// Crew: a fixed number of threads that work on one thing together, and meet at barriers.
#pragma once

#include <atomic>
#include <cstdint>
#include <thread>
#include <type_traits>
#include <vector>

namespace flowdlo::reference {

/// Threads live as long as the crew and sleep between calls. Nothing is allocated after
/// construction.
class Crew {
 public:
  /// `threads` with the caller's own; 0: one for each core.
  explicit Crew(int threads);
  ~Crew();
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;

  [[nodiscard]] int size() const { return static_cast<int>(workers_.size()) + 1; }

  /// work(thread) on every thread, 0 being the caller; returns when all are done. Not reentrant.
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

  std::vector<std::thread> workers_;
  Job job_;                              // no work: the workers end
  std::atomic<std::uint32_t> round_{0};  // of run(): its change starts the workers
  std::atomic<std::uint32_t> phase_{0};  // of meet(): its change lets everyone go on
  std::atomic<int> missing_{0};          // at the barrier
};

}  // namespace flowdlo::reference
