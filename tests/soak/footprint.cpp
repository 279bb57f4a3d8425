#include "footprint.hpp"

#include <malloc.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace flowdlo::soak {
namespace {

int entries(const char* folder) {
  const std::filesystem::directory_iterator all(folder);
  return static_cast<int>(std::distance(begin(all), end(all)));
}

}  // namespace

Footprint footprint() {
#ifdef __GLIBC__
  ::malloc_trim(0);
#endif
  std::ifstream file("/proc/self/statm");
  double pages = 0;
  double resident_pages = 0;
  file >> pages >> resident_pages;
  Footprint now;
#ifdef __GLIBC__
  const auto heap = ::mallinfo2();  // of all arenas; what is mapped for one block stands apart
  now.heap_mb = static_cast<double>(heap.uordblks + heap.hblkhd) / 1.0e6;
#endif
  now.resident_mb = resident_pages * static_cast<double>(::sysconf(_SC_PAGESIZE)) / 1.0e6;
  now.descriptors = entries("/proc/self/fd");
  now.threads = entries("/proc/self/task");
  return now;
}

}  // namespace flowdlo::soak
