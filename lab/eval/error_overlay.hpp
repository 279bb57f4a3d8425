// ErrorOverlay: an estimate beside the truth as a picture.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "flowdlo/centerline.hpp"
#include "flowdlo/frame.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::eval {

/// Left the image around the rope, dimmed off the mask: truth green, estimate red and yellow where
/// `support` [64] is 0, first nodes ringed, white lines between nodes of equal index. Right the
/// depths along the nodes. No support at all: every node red. Fails with kInternal when the picture
/// cannot be encoded.
[[nodiscard]] Result<std::vector<std::uint8_t>> error_overlay_png(
    const Frame& frame, const Centerline& truth, const Centerline& nodes,
    std::span<const std::uint8_t> support = {});

}  // namespace flowdlo::eval
