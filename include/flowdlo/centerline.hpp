// Centerline: the ordered state of a rope, Eq. (2.1).
#pragma once

#include <array>

namespace flowdlo {

inline constexpr int kNodes = 64;  ///< N, Sec. 3.1

/// A point of the camera frame: x right, y down, z forward, metres unless its name says otherwise.
struct Point3 {
  float x = 0;
  float y = 0;
  float z = 0;

  friend bool operator==(const Point3&, const Point3&) = default;
};

/// [64, 3] nodes from one end of the rope to the other, Eq. (2.1).
using Centerline = std::array<Point3, kNodes>;

}  // namespace flowdlo
