// Caught: an exception that must not leave the library, as an Error.
#pragma once

#include "flowdlo/result.hpp"

namespace flowdlo::guard {

/// The exception that is being handled: to be called within a catch block. Memory that ran out, of
/// ours or of OpenCV's, is kOutOfMemory, anything else kInternal. Where no memory is left for a
/// sentence the message is "out of memory", which needs none.
[[nodiscard]] Error caught(const char* who) noexcept;

}  // namespace flowdlo::guard
