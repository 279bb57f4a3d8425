// Caught: an exception that must not leave the library, as an Error.
#pragma once

#include <exception>
#include <utility>

#include "flowdlo/result.hpp"

namespace flowdlo::guard {

/// An Error on its way out of functions that have no Result to put it in.
class Failure : public std::exception {
 public:
  explicit Failure(Error error) : error_(std::move(error)) {}

  [[nodiscard]] const Error& error() const noexcept { return error_; }
  [[nodiscard]] const char* what() const noexcept override { return error_.message.c_str(); }

 private:
  Error error_;
};

/// The exception that is being handled: to be called within a catch block. A Failure is its Error.
/// Memory that ran out, of ours or of OpenCV's, is kOutOfMemory, anything else kInternal. Where no
/// memory is left for a sentence the message is "out of memory", which needs none.
[[nodiscard]] Error caught(const char* who) noexcept;

}  // namespace flowdlo::guard
