// Descriptor: an open file or folder, closed with its owner.
#pragma once

#include <utility>

#include "files/system_calls.hpp"

namespace flowdlo::files {

class Descriptor {
 public:
  Descriptor() = default;
  Descriptor(int value, const SystemCalls& calls) : value_(value), calls_(&calls) {}
  Descriptor(Descriptor&& other) noexcept
      : value_(std::exchange(other.value_, -1)), calls_(other.calls_) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    if (this != &other) {
      (void)close();
      value_ = std::exchange(other.value_, -1);
      calls_ = other.calls_;
    }
    return *this;
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { (void)close(); }

  [[nodiscard]] bool is_open() const { return value_ >= 0; }
  [[nodiscard]] int get() const { return value_; }

  /// False, with errno, where the system lost what was written. Closed in either case: after an
  /// interruption too, so that it must not be tried again.
  [[nodiscard]] bool close() { return value_ < 0 || calls_->close(std::exchange(value_, -1)) == 0; }

 private:
  int value_ = -1;
  const SystemCalls* calls_ = nullptr;
};

}  // namespace flowdlo::files
