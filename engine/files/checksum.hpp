// Checksum: 64 bits by which contents are told apart (FNV-1a). No protection against an opponent.
#pragma once

#include <cstdint>
#include <string_view>

namespace flowdlo::files {

/// Of `bytes` after whatever `so_far` is of.
[[nodiscard]] inline std::uint64_t checksum(std::string_view bytes,
                                            std::uint64_t so_far = 14695981039346656037ULL) {
  for (const char byte : bytes) {
    so_far = (so_far ^ static_cast<unsigned char>(byte)) * 1099511628211ULL;
  }
  return so_far;
}

}  // namespace flowdlo::files
