// PngFile: what fuzz targets and their mutator know about the bytes of a PNG.
#pragma once

#include <cstdint>
#include <span>

namespace flowdlo::fuzz {

/// Whether `bytes` announce an image of more pixels than a fuzzer has time for. What announces
/// sides beyond the library's limit is refused before any pixel, and is not meant.
[[nodiscard]] bool is_large_png(std::span<const std::uint8_t> bytes);

/// Makes the checksums of every chunk fit, of every PNG that lies somewhere in `bytes`: without
/// that no mutation gets past them.
void mend_png_checksums(std::span<std::uint8_t> bytes);

}  // namespace flowdlo::fuzz
