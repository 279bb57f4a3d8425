// WorkingFolder: a folder of this process, gone when it ends. scripts/fuzz puts it into memory.
#pragma once

#include <unistd.h>

#include <filesystem>
#include <string>

namespace flowdlo::fuzz {

class WorkingFolder {
 public:
  WorkingFolder()
      : path_(std::filesystem::temp_directory_path() /
              ("flowdlo-fuzz-" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path_);
  }
  WorkingFolder(const WorkingFolder&) = delete;
  WorkingFolder& operator=(const WorkingFolder&) = delete;
  ~WorkingFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace flowdlo::fuzz
