// Faults: everything that is wrong with one input, collected before anyone is told.
#pragma once

#include <string>

#include "flowdlo/result.hpp"

namespace flowdlo::frame {

/// Collects error lines. The code is kIo while every fault is one of reading or writing, and
/// kBadInput as soon as some content breaks its contract.
class Faults {
 public:
  void add(const Error& fault) {
    if (message_.empty() || fault.code != ErrorCode::kIo) code_ = fault.code;
    if (!message_.empty()) message_ += '\n';
    message_ += fault.message;
  }
  void bad_input(const std::string& line) { add({ErrorCode::kBadInput, line}); }

  [[nodiscard]] bool empty() const { return message_.empty(); }
  [[nodiscard]] Error error() const { return {code_, message_}; }

 private:
  ErrorCode code_ = ErrorCode::kBadInput;
  std::string message_;
};

}  // namespace flowdlo::frame
