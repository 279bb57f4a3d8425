// camera.json: intrinsics and depth scale, in our own form, BOP's or Open3D's.
#pragma once

#include <string>
#include <string_view>

#include "flowdlo/frame.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::frame {

struct CameraFile {
  int width = 0;   ///< pixels; 0: the file does not say (BOP)
  int height = 0;  ///< pixels; 0: the file does not say (BOP)
  Intrinsics intrinsics;
  double depth_scale_m = 0;  ///< metres a unit of depth.png
};

/// Reads one of three forms, told apart by their keys:
///   own     width, height, fx, fy, cx, cy, depth_scale (metres a unit)
///   BOP     cam_K [9] row-major, depth_scale (millimetres a unit); width and height optional
///   Open3D  width, height, intrinsic_matrix [9] column-major; depth_scale (metres a unit) is
///           optional and 0.001 when absent
/// Fails with kBadInput; every fault is a line that begins with `who`, the file's name.
[[nodiscard]] Result<CameraFile> parse_camera(std::string_view text, const std::string& who);

/// The text of a camera.json in our own form.
[[nodiscard]] std::string format_camera(const CameraFile& camera);

}  // namespace flowdlo::frame
