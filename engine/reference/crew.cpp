#include "reference/crew.hpp"

#include <unistd.h>

#include "threads/team.hpp"

namespace flowdlo::reference {
namespace {

// Some ten microseconds: longer than one operation's work differs between threads, far shorter
// than a frame. Whoever waits longer sleeps.
constexpr int kSpins = 400;

void pause_briefly() {
#if defined(__x86_64__) || defined(__i386__)
  __builtin_ia32_pause();
#elif defined(__aarch64__)
  asm volatile("yield");
#endif
}

void await_change(const std::atomic<std::uint32_t>& value, std::uint32_t old) {
  for (int i = 0; i < kSpins; ++i) {
    if (value.load(std::memory_order_acquire) != old) return;
    pause_briefly();
  }
  value.wait(old, std::memory_order_acquire);
}

}  // namespace

Crew::Crew(int threads)
    : process_(::getpid()), workers_(std::make_unique<std::vector<std::thread>>()) {
  *workers_ = threads::start(1, threads::count(threads), [this](int i) { serve(i); });
  size_ += static_cast<int>(workers_->size());
  missing_ = size_;
}

Crew::~Crew() {
  if (process_ != ::getpid()) {
    // Their handles may neither be joined nor detached here, and their destructor ends the process.
    (void)workers_.release();  // NOLINT: given up on purpose
    return;
  }
  job_ = {};
  round_.fetch_add(1, std::memory_order_release);
  round_.notify_all();
  for (std::thread& worker : *workers_) worker.join();
}

void Crew::meet() {
  if (size_ == 1) return;
  const std::uint32_t phase = phase_.load(std::memory_order_acquire);
  if (missing_.fetch_sub(1, std::memory_order_acq_rel) > 1) {
    await_change(phase_, phase);
    return;
  }
  missing_.store(size(), std::memory_order_relaxed);
  phase_.store(phase + 1, std::memory_order_release);
  phase_.notify_all();
}

void Crew::run(const Job& job) {
  job_ = job;
  if (size_ > 1) {
    round_.fetch_add(1, std::memory_order_release);
    round_.notify_all();
  }
  job.call(job.work, 0);
  meet();
}

void Crew::serve(int thread) {
  for (std::uint32_t round = 0;; ++round) {
    round_.wait(round, std::memory_order_acquire);
    if (job_.call == nullptr) return;
    job_.call(job_.work, thread);
    meet();
  }
}

}  // namespace flowdlo::reference
