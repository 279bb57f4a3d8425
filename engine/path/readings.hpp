// Readings: other ways of reading the same mask. A gap of a pixel, a speck, a border that frays or
// two strands that touch spoil one reading and not the next: what several agree on is right more
// often than what the first of them says.
#pragma once

#include <cstdint>
#include <vector>

#include "flowdlo/frame.hpp"
#include "flowdlo/result.hpp"
#include "path/path.hpp"

namespace flowdlo::path {

enum class Reading : std::uint8_t {
  kAsGiven,   ///< `trace`
  kHalved,    ///< at half the size: noise and short gaps vanish
  kDoubled,   ///< at twice the size, borders smoothed: room between thin strands
  kEroded,    ///< what hangs together by a pixel parts
  kDilated,   ///< what a pixel parts hangs together
  kMeasured,  ///< without the pixels that have no depth
};

/// Those beside kAsGiven that can show something new in a frame whose rope is that wide. Expects a
/// valid frame.
[[nodiscard]] std::vector<Reading> further_readings(const Frame& frame, float rope_width_px);

/// As `trace`, of the mask read that way; places and widths are those of the frame as it is.
/// Expects a valid frame. Fails with kNoPath where nothing is left of the mask.
[[nodiscard]] Result<Traversals> trace_as(Reading reading, const Frame& frame, float rope_width_px,
                                          const TraceConfig& config = {});

}  // namespace flowdlo::path
