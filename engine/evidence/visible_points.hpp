// Visible 3D evidence, Sec. 3.2: the cloud of measured pixels and its 256-point subset P_obs.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "flowdlo/centerline.hpp"
#include "flowdlo/frame.hpp"

namespace flowdlo::evidence {

inline constexpr int kVisiblePoints = 256;  ///< K_obs, Sec. 3.2

/// The raw set: every mask pixel with a usable depth, in row-major pixel order. Of a mask of more
/// than 2^21 pixels every second one, or every third, and so on: no cloud has more points than
/// that.
struct Cloud {
  std::vector<Point3> points_cam;  ///< [P, 3] metres
  std::vector<int> pixels;         ///< [P] index into the image, v * width + u
};

/// P_obs and m_obs. `valid[i]` is 1 for i < count; the rest repeats the cloud from its first point
/// on, or is zero when the cloud is empty.
struct VisiblePoints {
  std::array<Point3, kVisiblePoints> points_cam{};
  std::array<std::uint8_t, kVisiblePoints> valid{};
  int count = 0;
};

/// Mask > 0.5 (above 127), depth finite and above 1e-6 m, Eq. (2.2). Expects a valid frame. A pixel
/// whose point is not finite (a depth near the end of the float range) is left out.
[[nodiscard]] Cloud unproject(const Frame& frame);

/// The point at which farthest-point sampling starts is the one farthest from this: the mean of
/// all points, summed in double in order, rounded to float.
[[nodiscard]] Point3 centroid(const Cloud& cloud);

/// Farthest-point sampling where the cloud has more than 256 points, ties to the lower index;
/// otherwise every point, then repetitions.
[[nodiscard]] VisiblePoints visible_points(const Cloud& cloud);

}  // namespace flowdlo::evidence
