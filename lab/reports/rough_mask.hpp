// RoughMask: a rope's mask made worse in one way, by an amount that is counted in rope widths.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "flowdlo/frame_folder.hpp"

namespace flowdlo::lab {

struct Roughness {
  std::string name;
  /// The frame with its mask made worse. `width_px` is the rope's, `seed` draws what is random.
  std::function<FrameFolder(const FrameFolder& frame, double width_px, std::uint64_t seed)> apply;
};

/// Every kind in every amount, the mask as it came first.
[[nodiscard]] std::vector<Roughness> roughnesses();

}  // namespace flowdlo::lab
