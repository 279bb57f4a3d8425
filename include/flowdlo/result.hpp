// Result<T>: a value, or an Error that says who failed, what was expected, what came, what to do.
#pragma once

#include <cassert>
#include <string>
#include <utility>
#include <variant>

namespace flowdlo {

/// Why a call has no value. Stable: programs may switch on it.
enum class ErrorCode {
  kBadInput,     ///< a frame, file or configuration violates its contract
  kNoEvidence,   ///< no mask pixel carries a usable depth
  kNoPath,       ///< the mask holds no stroke that a rope could have drawn
  kBadWeights,   ///< the weights file is missing, damaged, or of another model
  kNoDevice,     ///< no device fits what was asked for
  kDeviceLost,   ///< the device failed, hung past its timeout, or ran out of its own memory
  kIo,           ///< a file could not be read or written
  kInternal,     ///< a defect of this library; please report it
  kOutOfMemory,  ///< the call found no memory; nothing is broken, it may be tried again
};

/// The code's name without its k, in snake_case: "no_path".
[[nodiscard]] constexpr const char* name_of(ErrorCode code) {
  switch (code) {
    case ErrorCode::kBadInput:
      return "bad_input";
    case ErrorCode::kNoEvidence:
      return "no_evidence";
    case ErrorCode::kNoPath:
      return "no_path";
    case ErrorCode::kBadWeights:
      return "bad_weights";
    case ErrorCode::kNoDevice:
      return "no_device";
    case ErrorCode::kDeviceLost:
      return "device_lost";
    case ErrorCode::kIo:
      return "io";
    case ErrorCode::kInternal:
      return "internal";
    case ErrorCode::kOutOfMemory:
      return "out_of_memory";
  }
  return "internal";
}

struct Error {
  ErrorCode code = ErrorCode::kInternal;
  std::string message;  ///< "who: expected A, got B; do C"; every fault found, one a line
};

/// A value or an Error. Reading the wrong one is a programmer's mistake and asserts.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : content_(std::in_place_index<0>, std::move(value)) {}      // NOLINT
  Result(Error error) : content_(std::in_place_index<1>, std::move(error)) {}  // NOLINT

  [[nodiscard]] bool has_value() const { return content_.index() == 0; }
  explicit operator bool() const { return has_value(); }

  [[nodiscard]] T& operator*() & { return value(); }
  [[nodiscard]] const T& operator*() const& { return value(); }
  [[nodiscard]] T&& operator*() && { return std::move(value()); }
  [[nodiscard]] T* operator->() { return &value(); }
  [[nodiscard]] const T* operator->() const { return &value(); }

  [[nodiscard]] const Error& error() const {
    assert(!has_value());
    return *std::get_if<1>(&content_);
  }

 private:
  T& value() {
    assert(has_value());
    return *std::get_if<0>(&content_);
  }
  const T& value() const {
    assert(has_value());
    return *std::get_if<0>(&content_);
  }

  std::variant<T, Error> content_;
};

/// Success without a value, or an Error.
template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : error_(std::move(error)), failed_(true) {}  // NOLINT

  [[nodiscard]] bool has_value() const { return !failed_; }
  explicit operator bool() const { return has_value(); }

  [[nodiscard]] const Error& error() const {
    assert(failed_);
    return error_;
  }

 private:
  Error error_;
  bool failed_ = false;
};

}  // namespace flowdlo
