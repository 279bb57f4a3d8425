// Distance: from each pixel of a mask to the nearest one that is empty.
#pragma once

#include "image/image.hpp"

namespace flowdlo::image {

/// Pixels, within 2 % of the Euclidean distance: the shortest way of steps to the side (1), aslant
/// (1.4) and of a knight (2.1969), in units of 1 / 65536. Where nothing is empty, 8192.
[[nodiscard]] Image<float> distance_to_empty(const Image<const std::uint8_t>& mask);

}  // namespace flowdlo::image
