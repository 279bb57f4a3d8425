// PartOfRope: a frame whose mask shows a part of its rope.
#pragma once

#include "flowdlo/frame_folder.hpp"

namespace flowdlo::lab {

/// `frame` with the mask of the rope between two shares of its length, in [0, 1]; what of the mask
/// is nearer to the rest of the rope is taken away. Depth and colour stay. `frame` has truth.
[[nodiscard]] FrameFolder part_of_rope(const FrameFolder& frame, double from, double to);

}  // namespace flowdlo::lab
