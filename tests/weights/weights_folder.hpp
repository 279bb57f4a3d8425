// WeightsFolder: a test's own folder, with what tests of files of weights ask of it.
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "frame/temporary_folder.hpp"

namespace flowdlo::test {

class WeightsFolder : public TemporaryFolder {
 public:
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const {
    return path() / name;
  }
  [[nodiscard]] std::ptrdiff_t entries() const {
    const std::filesystem::directory_iterator all(path());
    return std::distance(begin(all), end(all));
  }
};

inline std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

inline void write_bytes(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream stream(file, std::ios::binary);
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

}  // namespace flowdlo::test
