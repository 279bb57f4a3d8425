// Team: threads for a piece of work, as many as the system gives. A limit on processes or on memory
// makes work slower; it ends nothing.
#pragma once

#include <atomic>
#include <exception>
#include <new>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "threads/count.hpp"

namespace flowdlo::threads {

/// Starts threads of work(first), work(first + 1) up to work(last - 1) until one cannot be started.
/// The caller joins those that there are.
template <class Work>
[[nodiscard]] std::vector<std::thread> start(int first, int last, const Work& work) {
  std::vector<std::thread> started;
  try {
    if (last > first) started.reserve(static_cast<std::size_t>(last - first));
    for (int i = first; i < last; ++i) started.emplace_back(work, i);
  } catch (const std::system_error&) {  // no more threads to be had
  } catch (const std::bad_alloc&) {
  }
  return started;
}

/// work(0) here and work(1) up to work(count(threads) - 1) on threads of their own, as far as they
/// can be started: whoever comes must be ready to do everything. Returns when all are done. Of what
/// they throw, one is thrown again here.
template <class Work>
void work_together(int threads, const Work& work) {
  std::exception_ptr thrown;
  std::atomic<bool> failed = false;
  const auto handing_over = [&](int who) {
    try {
      work(who);
    } catch (const std::exception&) {
      if (!failed.exchange(true)) thrown = std::current_exception();
    }
  };
  std::vector<std::thread> others = start(1, count(threads), std::cref(handing_over));
  handing_over(0);
  for (std::thread& other : others) other.join();
  if (thrown) std::rethrow_exception(thrown);
}

}  // namespace flowdlo::threads
