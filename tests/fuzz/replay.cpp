// replay FOLDER: one target over the seeds of a folder, without libFuzzer: for every build.
#include <sys/resource.h>
#include <sys/time.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "target.hpp"

namespace {

namespace fs = std::filesystem;

// Of the processor, so that a machine under load changes nothing; the sanitizers' builds are within
// both as well.
constexpr time_t kMostSeconds = 20;
constexpr long kMostMemory_kb = 1L << 20;

std::vector<fs::path> files_of(const fs::path& folder) {
  std::error_code failure;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(folder, failure)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

/// Ends the process when it has computed for that long from now on; 0: no longer.
void end_after(time_t seconds) {
  const itimerval limit{{0, 0}, {seconds, 0}};
  setitimer(ITIMER_PROF, &limit, nullptr);
}

/// False where this input, or one before it, took more than it may.
bool replay(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(stream), {}};
  end_after(kMostSeconds);
  LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  end_after(0);
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss <= kMostMemory_kb;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) {
    std::fprintf(stderr, "usage: %s FOLDER\n", arguments[0]);
    return 2;
  }
  const auto files = files_of(arguments[1]);
  for (const fs::path& file : files) {
    std::fprintf(stderr, "%s\n", file.filename().c_str());  // the last one named is the culprit
    if (replay(file)) continue;
    std::fprintf(stderr, "took more than %ld kB\n", kMostMemory_kb);
    return 1;
  }
  std::printf("%zu seeds\n", files.size());
  return files.empty() ? 1 : 0;
}
