// Window: a part of a frame at another scale, and the way back from it.
#pragma once

#include <opencv2/core.hpp>

#include "flowdlo/frame.hpp"
#include "path/path.hpp"

namespace flowdlo::path {

struct Window {
  cv::Rect part;    ///< of the frame, pixels
  float scale = 1;  ///< pixels of the window for each of the frame

  /// Of the frame with that camera, seen through the window.
  [[nodiscard]] Intrinsics camera(const Intrinsics& frame) const;

  /// Brings what was traced in the window back to the pixels of a frame of that size: samples again
  /// about a pixel apart, widths in the frame's pixels.
  void restore(Traversals& traversals, const cv::Size& frame) const;
  void restore(RopePaths& paths, const cv::Size& frame) const;

 private:
  void restore(Path& path, const cv::Size& frame) const;
};

/// Copies of a part of a frame.
[[nodiscard]] cv::Mat mask_in(const Frame& frame, const cv::Rect& part);
[[nodiscard]] cv::Mat depth_in(const Frame& frame, const cv::Rect& part);
[[nodiscard]] cv::Mat instances_in(const Frame& frame, const cv::Rect& part);  ///< or empty

/// Views of the images, of one size and without padding; `instances` may be empty.
[[nodiscard]] Frame frame_of(const cv::Mat& mask, const cv::Mat& depth_m, const cv::Mat& instances,
                             const Intrinsics& camera);

/// The rectangle of that frame around `box`, `around_px` wider on every side.
[[nodiscard]] cv::Rect widened(const cv::Rect& box, int around_px, const cv::Size& frame);

}  // namespace flowdlo::path
