// Parse: a JSON text as a Value.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "json/value.hpp"

namespace flowdlo::json {

/// Arrays and objects nested deeper than this are read over: they are there, and empty.
inline constexpr int kDeepest = 16;

struct Parsed {
  bool fine = false;               ///< the text is JSON, in UTF-8
  Value value;                     ///< where fine
  int depth = 0;                   ///< of nesting; 1: an array or object of plain values
  std::vector<std::string> twice;  ///< keys that one object gives more than once, sorted, each once
  std::size_t fault_at = 0;        ///< where not fine: bytes read until the fault
  bool too_large = false;          ///< the fault is a number that no double can hold
};

/// Never fails but for want of memory.
[[nodiscard]] Parsed parse(std::string_view text);

}  // namespace flowdlo::json
