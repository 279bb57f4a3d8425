// Footprint: what a process holds of the machine.
#pragma once

namespace flowdlo::soak {

struct Footprint {
  double resident_mb = 0;  ///< after free memory went back to the system
  double heap_mb = 0;      ///< of malloc's, asked for and not freed; 0 where malloc does not tell
  int descriptors = 0;     ///< open files
  int threads = 0;
};

/// Of this process, now.
[[nodiscard]] Footprint footprint();

}  // namespace flowdlo::soak
