// Terminal: what the command prints. Names come from files and drivers, and may hold anything.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdio>
#include <string_view>
#include <utility>

namespace flowdlo::support {

/// Writes `text` with its control characters written out; line ends and tabs stay. A stream that
/// takes nothing is no exception: finished() tells.
void say(std::FILE* stream, std::string_view text);

/// To standard output.
template <class... Arguments>
void tell(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  say(stdout, fmt::format(format, std::forward<Arguments>(arguments)...));
}

/// To standard error.
template <class... Arguments>
void tell_error(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
  say(stderr, fmt::format(format, std::forward<Arguments>(arguments)...));
}

/// The exit code of a process that was about to end with `exit_code`: 1 in place of 0 where
/// standard output did not take everything, with a sentence on standard error.
[[nodiscard]] int finished(std::string_view who, int exit_code);

}  // namespace flowdlo::support
