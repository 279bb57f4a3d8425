#include "guard/caught.hpp"

#include <exception>
#include <new>
#include <string>

namespace flowdlo::guard {
namespace {

Error out_of_memory(const char* who) noexcept {
  try {
    return {
        ErrorCode::kOutOfMemory,
        std::string(who) + ": expected memory for this call, got none; free some and try again"};
  } catch (const std::exception&) {
    return {ErrorCode::kOutOfMemory,
            "out of memory"};  // short enough to stand in the string itself
  }
}

/// A copy: another thread may still hold the exception.
Error failed(const char* who, const Failure& failure) noexcept {
  try {
    return failure.error();
  } catch (const std::exception&) {
    return out_of_memory(who);
  }
}

Error unexpected(const char* who, const std::exception& thrown) noexcept {
  try {
    return {ErrorCode::kInternal, std::string(who) + ": expected no exception, got \"" +
                                      thrown.what() + "\"; please report it"};
  } catch (const std::exception&) {
    return out_of_memory(who);
  }
}

}  // namespace

Error caught(const char* who) noexcept {
  try {
    throw;
  } catch (const std::bad_alloc&) {
    return out_of_memory(who);
  } catch (const Failure& failure) {
    return failed(who, failure);
  } catch (const std::exception& thrown) {
    return unexpected(who, thrown);
  }
}

}  // namespace flowdlo::guard
