// Resident memory of this process.
#pragma once

#include <unistd.h>

#include <fstream>

namespace flowdlo::support {

/// What it holds now, in MB.
[[nodiscard]] inline double resident_mb() {
  std::ifstream file("/proc/self/statm");
  double pages = 0;
  double resident_pages = 0;
  file >> pages >> resident_pages;
  return resident_pages * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1.0e6;
}

}  // namespace flowdlo::support
