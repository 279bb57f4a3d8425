// WholeNumber: an option whose value is any whole number of 64 bits, such as a seed.
#pragma once

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <charconv>
#include <cstdint>
#include <limits>
#include <string>
#include <system_error>

#include "files/shown_name.hpp"

namespace flowdlo::support {

/// Refuses what does not fit: CLI11 takes the largest number there is for it.
[[nodiscard]] inline CLI::Validator whole_number() {
  return {[](const std::string& text) {
            std::uint64_t value = 0;
            const char* const end = text.data() + text.size();
            const auto read = std::from_chars(text.data(), end, value);
            if (read.ec == std::errc() && read.ptr == end) return std::string();
            return fmt::format("expected a whole number from 0 to {}, got \"{}\"",
                               std::numeric_limits<std::uint64_t>::max(), files::shown(text));
          },
          ""};
}

}  // namespace flowdlo::support
