// Line: polylines one pixel wide.
#pragma once

#include <span>

#include "image/image.hpp"

namespace flowdlo::image {

/// Sets the pixels from each point to the next, which come with them, from pixel to pixel over
/// sides and corners; one point alone draws nothing. What lies beyond the image is not drawn; where
/// a line is cut by its border, the rest goes from there.
void draw_polyline(Mask& mask, std::span<const Point> points, std::uint8_t value);

}  // namespace flowdlo::image
