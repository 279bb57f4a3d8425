// Lanes: functions compiled once more for processors with wide vectors and fused multiplication and
// addition; chosen at run time, so that one library serves all.
#pragma once

namespace flowdlo::image {

#if defined(__x86_64__) && defined(__GNUC__)
#define FLOWDLO_WIDE_LANES [[gnu::target("avx2,fma")]]
#endif

/// Whether functions with FLOWDLO_WIDE_LANES may be called; where there is no such thing, never.
inline bool has_wide_lanes() {
#ifdef FLOWDLO_WIDE_LANES
  return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
#else
  return false;
#endif
}

}  // namespace flowdlo::image
