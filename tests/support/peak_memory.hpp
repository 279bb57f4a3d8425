// PeakMemory: how much more memory than before something took, at its worst moment.
#pragma once

#include <fstream>
#include <string>

namespace flowdlo::test {

/// Whether a sanitizer keeps what is freed, so that memory is not the tested code's alone.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif
#else
inline constexpr bool kSanitized = false;
#endif

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
