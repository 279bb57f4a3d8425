// Line: straight lines and polylines one pixel wide.
#pragma once

#include <span>

#include "image/image.hpp"

namespace flowdlo::image {

enum class Steps {
  kSide,    ///< from pixel to pixel over their sides
  kAslant,  ///< over their corners as well
};

/// Sets the pixels between both points, which come with them. What lies beyond the image is not
/// drawn; where a line is cut by its border, the rest goes from there.
void draw_line(Mask& mask, Point from, Point to, std::uint8_t value, Steps steps);

/// From each point to the next; one point alone draws nothing.
void draw_polyline(Mask& mask, std::span<const Point> points, std::uint8_t value, Steps steps);

}  // namespace flowdlo::image
