// Eq. (3.8)-(3.10): normalisation of points and its inverse. Rows are [x, y, z, w]; w is copied.
#pragma once

#include <span>

namespace flowdlo::reference {

/// norm [4] = (mean, scale) of the rows of points [256, 4] whose w is above 0.5; see
/// ops::FrameNormalization.
void frame_normalization(std::span<const float> points, std::span<float> norm);

/// out = (points - mean) / scale.
void normalize(std::span<const float> points, std::span<const float> norm, std::span<float> out);

/// out = scale * state + mean.
void denormalize(std::span<const float> state, std::span<const float> norm, std::span<float> out);

}  // namespace flowdlo::reference
