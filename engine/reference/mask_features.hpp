// Local features phi_M(u_j), Sec. 3.4 and spec section 6. Twin of shaders/mask_features.
#pragma once

#include <span>

#include "ops/program.hpp"

namespace flowdlo::reference {

/// See ops::MaskFeatures. `depth` is empty for six channels.
void mask_features(std::span<const float> state, std::span<const float> norm,
                   const ops::FrameParams& params, std::span<const float> field,
                   std::span<const float> depth, std::span<float> out);

}  // namespace flowdlo::reference
