// Thinning: a mask to lines one pixel wide, of the same topology.
#pragma once

#include "image/image.hpp"

namespace flowdlo::path {

/// The skeleton of `mask` (0 or 1, its outermost pixels 0), same shape and values.
/// Every component keeps at least one pixel; deterministic.
[[nodiscard]] image::Mask thin(const image::Mask& mask);

}  // namespace flowdlo::path
