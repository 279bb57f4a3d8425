#include "command/build_sum.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>

namespace flowdlo::lab {
namespace {

namespace fs = std::filesystem;

// FNV-1a: told apart, not protected.
constexpr std::uint64_t kBasis = 14695981039346656037ULL;
constexpr std::uint64_t kPrime = 1099511628211ULL;

std::uint64_t summed(const fs::path& file, std::uint64_t sum) {
  std::ifstream stream(file, std::ios::binary);
  for (std::istreambuf_iterator<char> byte(stream), end; byte != end; ++byte) {
    sum = (sum ^ static_cast<std::uint8_t>(*byte)) * kPrime;
  }
  return sum;
}

// The library as it was loaded: found by the linker, not necessarily beside the program.
std::set<fs::path> loaded_libraries() {
  std::set<fs::path> files;
  std::ifstream maps("/proc/self/maps");
  for (std::string line; std::getline(maps, line);) {
    const auto slash = line.find('/');
    if (slash == std::string::npos) continue;
    const fs::path file = line.substr(slash);
    if (file.filename().string().starts_with("libflowdlo")) files.insert(file);
  }
  return files;
}

}  // namespace

std::string build_sum() {
  std::uint64_t sum = summed("/proc/self/exe", kBasis);
  if (sum == kBasis) return "unknown";
  for (const fs::path& file : loaded_libraries()) sum = summed(file, sum);
  return fmt::format("{:016x}", sum);
}

}  // namespace flowdlo::lab
