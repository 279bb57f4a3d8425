// Failure: the error of a system call, with the file, the reason and what to do.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "flowdlo/result.hpp"

namespace flowdlo::files {

/// kIo: "FILE: cannot be WHAT: REASON; REMEDY". `code` is an errno.
[[nodiscard]] Error failure(const std::filesystem::path& file, std::string_view what, int code);

}  // namespace flowdlo::files
