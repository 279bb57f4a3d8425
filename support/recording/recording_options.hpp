// RecordingOptions: where in a recording the frames are.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <string>

#include "flowdlo/result.hpp"

namespace flowdlo::recording {

/// A topic may also be recorded as NAME/compressed or NAME/compressedDepth.
struct RecordingOptions {
  std::string color_topic = "/camera/color/image_raw";
  std::string depth_topic = "/camera/aligned_depth_to_color/image_raw";
  std::string camera_topic = "/camera/color/camera_info";
  std::string mask_topic;  ///< empty: the mask is made by `hsv`
  /// Low and high hue, saturation and value, in OpenCV's units; the hue may go through red.
  std::optional<std::array<int, 6>> hsv;
  double sync_tolerance_ms = 20;  ///< of every partner to the depth image
  int every = 1;                  ///< of the matched sets within from-to
  double from_s = 0;              ///< since the first depth image
  double to_s = std::numeric_limits<double>::infinity();
  bool rectified = false;      ///< the images are pinhole images: P of the camera info holds
  bool color_required = true;  ///< false: the colour topic was not asked for, only looked for
};

/// Fails with kBadInput, naming `who`, where options contradict each other or mean nothing.
[[nodiscard]] Result<void> check(const RecordingOptions& options, const std::string& who);

}  // namespace flowdlo::recording
