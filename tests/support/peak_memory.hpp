// PeakMemory: how much more memory than before something took, at its worst moment.
#pragma once

#include <fstream>
#include <string>

namespace flowdlo::test {

/// MB that /proc/self/status says of `what`: VmRSS now, VmHWM at most since it was last reset.
inline double status_mb(const std::string& what) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    double kilobytes = 0;
    if (word == what + ":" && status >> kilobytes) return kilobytes / 1000;
  }
  return 0;
}

/// MB of resident memory that `work` took at its worst moment, beyond what was there before it.
template <class Work>
double peak_growth_mb(const Work& work) {
  std::ofstream("/proc/self/clear_refs") << "5";  // the peak starts again from what is there now
  const double before_mb = status_mb("VmHWM");
  work();
  return status_mb("VmHWM") - before_mb;
}

}  // namespace flowdlo::test
