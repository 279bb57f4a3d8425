// MaskRuns: a binary mask as runs of set pixels, a few kilobytes instead of the image's megapixel.
#pragma once

#include <cstdint>
#include <vector>

#include "flowdlo/frame.hpp"

namespace flowdlo::train {

/// `length` set pixels from (u, v) to the right.
struct MaskRun {
  std::uint16_t v = 0;
  std::uint16_t u = 0;
  std::uint16_t length = 0;

  friend bool operator==(const MaskRun&, const MaskRun&) = default;
};

struct MaskRuns {
  int width = 0;
  int height = 0;
  std::vector<MaskRun> runs;  ///< row-major order, apart from one another

  friend bool operator==(const MaskRuns&, const MaskRuns&) = default;
};

/// Pixels above 127, as the engine reads a mask.
[[nodiscard]] MaskRuns runs_of(const Frame& frame);

/// [height, width] 255 where set.
[[nodiscard]] std::vector<std::uint8_t> image_of(const MaskRuns& mask);

}  // namespace flowdlo::train
