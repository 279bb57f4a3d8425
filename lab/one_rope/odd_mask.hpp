// OddMask: masks that are no rope.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace flowdlo::lab {

struct OddMask {
  std::string name;
  std::vector<std::uint8_t> mask;  ///< [height, width]
};

/// Full ones, noise at every density, blobs, bars, checkers, grids, rings, text and more, each
/// alike on every call. About 50 of them.
[[nodiscard]] std::vector<OddMask> odd_masks(int width, int height);

}  // namespace flowdlo::lab
