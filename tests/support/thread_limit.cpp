#include "support/thread_limit.hpp"

#include <dlfcn.h>
#include <pthread.h>

#include <atomic>
#include <cerrno>
#include <limits>

namespace {

std::atomic<int> more = std::numeric_limits<int>::max();
std::atomic<int> refusals = 0;

}  // namespace

/// The system's, but for the limit.
extern "C" int pthread_create(pthread_t* thread, const pthread_attr_t* attributes,
                              void* (*work)(void*), void* argument) noexcept {
  using Create = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
  static const auto create = reinterpret_cast<Create>(dlsym(RTLD_NEXT, "pthread_create"));
  if (more.fetch_sub(1) <= 0) {
    ++more;
    ++refusals;
    return EAGAIN;
  }
  return create(thread, attributes, work, argument);
}

namespace flowdlo::testing {

ThreadLimit::ThreadLimit(int allowed) {
  refusals = 0;
  more = allowed;
}

ThreadLimit::~ThreadLimit() { more = std::numeric_limits<int>::max(); }

int ThreadLimit::refused() const { return refusals; }

}  // namespace flowdlo::testing
