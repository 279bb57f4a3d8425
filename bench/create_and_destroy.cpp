// What stays of estimators that are gone: memory in use, and memory that the process still holds,
// after each of several that were made and destroyed.
//
//   create_and_destroy [--device=NAME] [TIMES]
//
// Where the second grows and the first does not, nothing is lost: the C library keeps freed memory.
#include <malloc.h>

#include <cstdio>
#include <cstdlib>
#include <string>

#include "device_option.hpp"
#include "flowdlo/estimator.hpp"
#include "resident_memory.hpp"

int main(int argc, char** argv) {
  constexpr int kTimes = 40;
  const std::string device = flowdlo::bench::wanted_device(argc, argv);
  const int times = argc > 1 ? std::atoi(argv[argc - 1]) : 0;
  for (int i = 1; i <= (times > 0 ? times : kTimes); ++i) {
    if (const auto made = flowdlo::Estimator::create({.device = device}); !made) {
      std::fprintf(stderr, "%s\n", made.error().message.c_str());
      return 1;
    }
    if (i % 10 != 0) continue;
    const auto heap = ::mallinfo2();
    std::printf("%4d: %7.2f MB in use, %7.1f MB resident\n", i,
                static_cast<double>(heap.uordblks + heap.hblkhd) / 1e6,
                flowdlo::support::resident_mb());
  }
  return 0;
}
