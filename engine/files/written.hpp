// Written: bytes into an open file, all of them.
#pragma once

#include <cstdint>
#include <span>

#include "files/system_calls.hpp"

namespace flowdlo::files {

/// Goes on after interruptions and after writes that took a part. Zero, or the errno.
[[nodiscard]] int written(int file, std::span<const std::uint8_t> bytes, const SystemCalls& calls);

/// The same onto a pipe or a device that was opened with O_NONBLOCK: one that takes nothing for
/// kPatience_ms ends it with EAGAIN.
[[nodiscard]] int written_when_ready(int file, std::span<const std::uint8_t> bytes,
                                     const SystemCalls& calls);

constexpr int kPatience_ms = 30000;

}  // namespace flowdlo::files
