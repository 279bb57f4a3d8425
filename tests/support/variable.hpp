// Variable: a variable of the environment, as long as a test lasts.
#pragma once

#include <cstdlib>
#include <optional>
#include <string>

namespace flowdlo::test {

class Variable {
 public:
  Variable(const char* name, const std::string& value) : name_(name) {
    if (const char* const before = std::getenv(name); before != nullptr) before_ = before;
    ::setenv(name, value.c_str(), /*overwrite=*/1);
  }
  ~Variable() {
    if (before_) {
      ::setenv(name_, before_->c_str(), /*overwrite=*/1);
    } else {
      ::unsetenv(name_);
    }
  }
  Variable(const Variable&) = delete;
  Variable& operator=(const Variable&) = delete;

 private:
  const char* name_;
  std::optional<std::string> before_;
};

/// The Vulkan drivers that there are: manifests with colons between them, under both names that
/// loaders of different age know.
struct Drivers {
  explicit Drivers(const std::string& manifests)
      : files("VK_DRIVER_FILES", manifests), filenames("VK_ICD_FILENAMES", manifests) {}
  Variable files;
  Variable filenames;
};

}  // namespace flowdlo::test
