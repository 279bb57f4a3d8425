// Reduced: a part of a frame at a whole fraction of its size, for masks too large to be traced as
// they are.
#pragma once

#include <opencv2/core.hpp>

#include "flowdlo/frame.hpp"
#include "path/path.hpp"
#include "path/window.hpp"

namespace flowdlo::path {

/// By how much a mask in that box has to be reduced to be traced; 1: not at all.
[[nodiscard]] int reduction_of(const cv::Rect& box);

class Reduced {
 public:
  /// Copies the box and what lies around it; `times` squared pixels become one, which is mask where
  /// half of them are.
  Reduced(const Frame& frame, const cv::Rect& box, int times);

  /// Views into this object.
  [[nodiscard]] Frame frame() const;

  /// Brings what was traced in the reduced frame back to the pixels of the original.
  void enlarge(Traversals& traversals) const;
  void enlarge(RopePaths& paths) const;

 private:
  Window window_;
  cv::Size original_;
  Intrinsics camera_;
  cv::Mat depth_m_;
  cv::Mat mask_;
  cv::Mat instances_;
};

}  // namespace flowdlo::path
