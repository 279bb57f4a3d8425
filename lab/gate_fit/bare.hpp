// Bare: frames that lack what some cameras do not give.
#pragma once

#include <cstddef>
#include <cstdint>

#include "flowdlo/frame_folder.hpp"

namespace flowdlo::lab {

/// Some frames come without a picture, some with depth on the mask alone, some with neither: what
/// a strand field says of them is weighed as well.
inline void lay_bare(FrameFolder& frame, std::uint64_t index) {
  constexpr std::uint64_t kEvery = 12;  // of which five lack something
  const std::uint64_t turn = index % kEvery;
  const bool both = turn == 5;
  const bool no_picture = both || turn == 1 || turn == 7;
  const bool rope_depth_alone = both || turn == 3 || turn == 9;
  if (no_picture) frame.color_bgr.clear();
  if (!rope_depth_alone) return;
  for (std::size_t i = 0; i < frame.depth_m.size(); ++i) {
    if (frame.mask[i] == 0) frame.depth_m[i] = 0;
  }
}

}  // namespace flowdlo::lab
