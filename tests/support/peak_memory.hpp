// PeakMemory: how much more memory than before something took, at its worst moment.
#pragma once

#include <sys/resource.h>

namespace flowdlo::test {

/// MB that the process' resident memory rose above its earlier peak while `work` ran.
template <class Work>
double peak_growth_mb(const Work& work) {
  const auto peak_mb = [] {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<double>(usage.ru_maxrss) / 1000;
  };
  const double before_mb = peak_mb();
  work();
  return peak_mb() - before_mb;
}

}  // namespace flowdlo::test
