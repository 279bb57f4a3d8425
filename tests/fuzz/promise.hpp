// Promise: what must hold whatever the input. A broken one ends the process: the fuzzer then keeps
// the input, and the replay of the seeds fails.
#pragma once

#include <cstdio>
#include <cstdlib>

namespace flowdlo::fuzz {

inline void promise(bool kept, const char* words) {
  if (kept) return;
  std::fprintf(stderr, "broken promise: %s\n", words);
  std::abort();
}

}  // namespace flowdlo::fuzz
