// Aside: something done beside what the caller does.
#pragma once

#include <future>
#include <system_error>
#include <utility>

namespace flowdlo::threads {

/// What `work` gives or throws. It runs on a thread of its own where one is wanted and can be
/// started, otherwise when it is asked for.
template <class Work>
[[nodiscard]] auto aside(bool wanted, const Work& work) -> std::future<decltype(work())> {
  if (wanted) {
    try {
      return std::async(std::launch::async, work);
    } catch (const std::system_error&) {  // no more threads to be had
    }
  }
  return std::async(std::launch::deferred, work);
}

}  // namespace flowdlo::threads
