// Render: a rope as a swept sphere into depth, mask and colour, by z-buffer.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "flowdlo/frame.hpp"
#include "scene/curve.hpp"

namespace flowdlo::lab {

/// A straight bar across the image, in front of the rope.
struct Bar {
  Eigen::Vector2d point_px{0, 0};
  Eigen::Vector2d direction{1, 0};  ///< unit
  double half_width_px = 0;
  double depth_m = 0;
};

struct Image {
  int width = 0;
  int height = 0;
  Intrinsics camera;
  std::vector<float> depth_m;              ///< [height, width], of whatever is nearest
  std::vector<std::uint8_t> mask;          ///< [height, width], 255 where the rope is nearest
  std::vector<std::uint8_t> color_bgr;     ///< [height, width, 3]
  std::vector<std::uint16_t> instances{};  ///< [height, width] which of several ropes, from 1
};

/// One of several ropes.
struct Body {
  Curve3 curve;  ///< camera frame
  double radius_m = 0;
  Eigen::Vector3d color_rgb{215, 40, 35};
};

/// Background plane: points p of the camera frame with normal . p = offset_m.
struct Plane {
  Eigen::Vector3d normal{0, 0, 1};
  double offset_m = 1;
};

/// Draws background, rope (`curve` in the camera frame) and bars into `image`, whose size and
/// camera are given.
void render(const Curve3& curve, double radius_m, const Plane& background,
            const std::vector<Bar>& bars, Image& image);

/// Draws background and ropes, and says of each pixel which rope it shows.
void render(const std::vector<Body>& ropes, const Plane& background, Image& image);

}  // namespace flowdlo::lab
