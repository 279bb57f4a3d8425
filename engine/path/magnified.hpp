// Magnified: a part of a frame at a whole multiple of its size, for ropes a few pixels wide.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "flowdlo/frame.hpp"
#include "path/path.hpp"
#include "path/region.hpp"
#include "path/window.hpp"

namespace flowdlo::path {

class Magnified {
 public:
  /// Copies what `region` and its surroundings hold of `frame`; a pixel becomes `times` squared.
  Magnified(const Frame& frame, const Region& region, int times);

  /// Views into this object.
  [[nodiscard]] Frame frame() const;

  /// The region in it.
  [[nodiscard]] const Region& region() const { return region_; }

  /// Lines of the original region in it.
  [[nodiscard]] std::vector<std::vector<Eigen::Vector2f>> enlarged(
      std::vector<std::vector<Eigen::Vector2f>> lines) const;

  /// Brings what was traced in the magnified frame back to the pixels of the original.
  void shrink(Traversals& traversals) const;
  void shrink(RopePaths& paths) const;

 private:
  Window window_;
  cv::Size original_;
  Intrinsics camera_;
  Region region_;
  cv::Mat depth_m_;
  cv::Mat mask_;
  cv::Mat instances_;
};

}  // namespace flowdlo::path
