#include "reference/crew.hpp"

#include <algorithm>

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

int count_of(int threads) {
  if (threads > 0) return threads;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace

Crew::Crew(int threads) : missing_(count_of(threads)) {
  const int workers = count_of(threads) - 1;
  workers_.reserve(static_cast<std::size_t>(workers));
  for (int i = 1; i <= workers; ++i) workers_.emplace_back([this, i] { serve(i); });
}

Crew::~Crew() {
  job_ = {};
  round_.fetch_add(1, std::memory_order_release);
  round_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void Crew::meet() {
  if (workers_.empty()) return;
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
  if (!workers_.empty()) {
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
