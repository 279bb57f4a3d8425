// MaskOverlay: a mask over its image, for a person to judge at a glance.
#pragma once

#include "flowdlo/frame.hpp"
#include "picture.hpp"

namespace flowdlo::tools {

/// The image, dimmed and without its colours where frame.mask is not; as it is where the mask is,
/// with a line around it. Without a colour image the mask alone. The frame's size.
[[nodiscard]] support::Picture draw_mask_overlay(const Frame& frame);

}  // namespace flowdlo::tools
