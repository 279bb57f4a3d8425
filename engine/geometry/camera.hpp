// Pinhole projection and its inverse, Eq. (2.2).
#pragma once

#include <Eigen/Core>

#include "flowdlo/centerline.hpp"
#include "flowdlo/frame.hpp"

namespace flowdlo::geometry {

inline Eigen::Vector3f to_eigen(const Point3& point) { return {point.x, point.y, point.z}; }
inline Point3 to_point(const Eigen::Vector3f& vector) {
  return {vector.x(), vector.y(), vector.z()};
}

/// The camera-frame point (metres) seen at pixel (u, v) with z-depth `depth_m`. Eq. (2.2).
inline Point3 unproject(const Intrinsics& camera, float u_px, float v_px, float depth_m) {
  return {(u_px - camera.cx) * depth_m / camera.fx, (v_px - camera.cy) * depth_m / camera.fy,
          depth_m};
}

/// Pixel (u, v) of a camera-frame point. The caller makes sure that point.z > 0.
inline Eigen::Vector2f project(const Intrinsics& camera, const Point3& point) {
  return {camera.fx * point.x / point.z + camera.cx, camera.fy * point.y / point.z + camera.cy};
}

/// Thresholds in pixels are those of a 640-px-wide image (spec section 4): multiply by this.
inline float pixel_scale(int image_width) { return static_cast<float>(image_width) / 640.0F; }

}  // namespace flowdlo::geometry
