// Failed: how a command of the lab ends that cannot go on.
#pragma once

#include <fmt/format.h>

#include <cstdio>

#include "flowdlo/result.hpp"

namespace flowdlo::survey {

/// Tells why on stderr; `code` is the exit code.
inline int failed(const Error& error, int code = 1) {
  fmt::print(stderr, "{}\n", error.message);
  return code;
}

}  // namespace flowdlo::survey
