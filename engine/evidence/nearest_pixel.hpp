// NearestPixel: the exact Euclidean feature transform of a binary image.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace flowdlo::evidence {

/// [height, width] index v * width + u of the set pixel nearest to each pixel's centre, Euclidean
/// and exact; ties go to the lower index (lower v, then lower u). Empty when no pixel is set.
/// `set` is [height, width], set where not zero; width * height at most 2^22. Linear in the pixels.
[[nodiscard]] std::vector<std::int32_t> nearest_set_pixel(std::span<const std::uint8_t> set,
                                                          int width, int height);

}  // namespace flowdlo::evidence
