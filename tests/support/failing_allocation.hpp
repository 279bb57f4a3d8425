// FailingAllocation: makes memory run out at a chosen moment. Its source must be part of the test's
// own executable: operator new and, but for sanitizers, malloc and its kin are replaced in the
// whole process, so that what libstdc++, OpenCV, libpng and the system's loader take is counted as
// well.
#pragma once

namespace flowdlo::testing {

enum class Fails {
  kNever,   ///< only counts
  kOnce,    ///< that one allocation, or the first after it that may fail
  kFromOn,  ///< that one and all later ones: memory that never comes back
};

/// While it lives, allocations are counted from 1 in all threads, and fail as said. What libraries
/// that were opened at run time take, and whatever they call takes, is left alone: a Vulkan driver
/// does not outlive it.
class FailingAllocation {
 public:
  FailingAllocation(Fails fails, long number);
  ~FailingAllocation();
  FailingAllocation(const FailingAllocation&) = delete;
  FailingAllocation& operator=(const FailingAllocation&) = delete;

  [[nodiscard]] static long count();   ///< allocations of the last one that lived
  [[nodiscard]] static long failed();  ///< how many of them did
};

}  // namespace flowdlo::testing
