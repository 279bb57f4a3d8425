// Uninterrupted: a system call that begins again when a signal came between.
#pragma once

#include <cerrno>

namespace flowdlo::files {

/// What `call` returns once it was not interrupted. So many signals in a row mean that it never
/// will be: the last EINTR is its failure then.
template <class Call>
auto uninterrupted(const Call& call) -> decltype(call()) {
  constexpr int kMostInterruptions = 1000;
  auto result = call();
  for (int i = 0; result < 0 && errno == EINTR && i < kMostInterruptions; ++i) result = call();
  return result;
}

}  // namespace flowdlo::files
