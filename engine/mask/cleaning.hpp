// Cleaning: what is mended in every mask before it is handed out.
#pragma once

#include "flowdlo/mask.hpp"
#include "mask/regions.hpp"

namespace flowdlo::mask {

/// `mask`, 0 or 255, as MaskCleaning says.
[[nodiscard]] Mask cleaned(Mask mask, const Size& size, const MaskCleaning& cleaning);

}  // namespace flowdlo::mask
