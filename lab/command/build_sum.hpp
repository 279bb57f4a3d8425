// BuildSum: tells one build of flowdlo from another.
#pragma once

#include <string>

namespace flowdlo::lab {

/// Hexadecimal, of the bytes of this program and of the flowdlo library it runs with: equal where
/// both files are. "unknown" where they cannot be read.
[[nodiscard]] std::string build_sum();

}  // namespace flowdlo::lab
