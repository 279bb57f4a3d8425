// Failure: an Error of the library on its way to Python, where it becomes a class of
// flowdlo.errors.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include "flowdlo/result.hpp"

namespace flowdlo::python {

class Failure : public std::runtime_error {
 public:
  explicit Failure(const Error& error) : std::runtime_error(error.message), code_(error.code) {}

  [[nodiscard]] ErrorCode code() const { return code_; }

 private:
  ErrorCode code_;
};

[[noreturn]] inline void refuse(const std::string& message) {
  throw Failure({ErrorCode::kBadInput, message});
}

}  // namespace flowdlo::python
