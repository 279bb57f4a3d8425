// View: where the camera stands. Turns ropes into the camera's frame.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "synth/rope.hpp"
#include "synth/sensor.hpp"

namespace flowdlo::synth {

/// Points p with normal . p = offset_m, camera frame; the normal looks at the camera.
struct Plane {
  Vector3d normal{0, 0, -1};
  double offset_m = -1;
};

struct View {
  const Sensor* sensor = nullptr;
  Intrinsics camera;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();  ///< the ropes' frame to the camera's
  Vector3d shift{0, 0, 0};
  double distance_m = 0;  ///< to the middle of the ropes
  double tilt_rad = 0;
  Plane ground;  ///< the table, or the wall behind hanging ropes
  bool has_ground = true;
  std::vector<Curve> curves;  ///< of the ropes, camera frame

  [[nodiscard]] Vector3d in_camera(const Vector3d& p) const { return turn * p + shift; }
  [[nodiscard]] Vector2d project(const Vector3d& p_cam) const {
    return {camera.fx * p_cam.x() / p_cam.z() + camera.cx,
            camera.fy * p_cam.y() / p_cam.z() + camera.cy};
  }
};

/// 0.3 to 0.5 m above the table. Empty when the ropes do not fit into the image there.
[[nodiscard]] std::optional<View> try_thesis_view(std::span<const Rope> ropes, Dice& dice);

/// 0.25 to 1.5 m away, tilted by up to 70 degrees. Of some ropes a small part leaves the image.
/// Empty when the ropes do not fit, or would be thinner than two pixels or tiny.
[[nodiscard]] std::optional<View> try_wide_view(std::span<const Rope> ropes, Dice& dice);

/// The same from so near that some of the ropes leave the image.
[[nodiscard]] std::optional<View> try_near_view(std::span<const Rope> ropes, Dice& dice);

}  // namespace flowdlo::synth
