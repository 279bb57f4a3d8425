// Limits: what a frame may be. In one place, so that memory, file and JSON are held to the same.
#pragma once

namespace flowdlo::frame {

inline constexpr int kMaxSide_px = 4096;
inline constexpr float kMinFocal_px = 1.0F;    ///< below, a pixel spans more than 45 degrees
inline constexpr float kMaxFocal_px = 1.0e6F;  ///< above, rays are parallel in float
inline constexpr float kMostRope_m = 100;      ///< from a camera with depth; farther: millimetres
inline constexpr double kMaxDepthScale_m = 1;  ///< metres a unit of depth.png
inline constexpr int kMaxDepthUnit = 65535;    ///< of a 16-bit image
inline constexpr double kOpen3dDepthScale_m = 0.001;  ///< Open3D's files do not carry one

}  // namespace flowdlo::frame
