// Blur: images smoothed by a Gaussian.
#pragma once

#include <vector>

#include "image/image.hpp"

namespace flowdlo::image {

/// What lies beyond the image.
enum class Beyond {
  kZero,
  kMirrored,  ///< at its outermost pixels, which do not come twice
};

/// [taps] weights that sum to 1; `taps` is odd.
[[nodiscard]] std::vector<float> gaussian(int taps, double sigma_px);

/// Taps that reach four sigmas to each side.
[[nodiscard]] int taps_of(double sigma_px);

/// `image` smoothed by `taps` along rows and columns. Products are added as the processor does it
/// best: in one rounding where it has fused multiplication and addition, else in two.
[[nodiscard]] Image<float> blurred(const Image<const float>& image, const std::vector<float>& taps,
                                   Beyond beyond);

}  // namespace flowdlo::image
