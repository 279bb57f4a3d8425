// Magnified: a part of a frame at a whole multiple of its size, for ropes a few pixels wide.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "flowdlo/frame.hpp"
#include "path/path.hpp"
#include "path/region.hpp"

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

 private:
  cv::Rect part_;  // of the original
  Region region_;
  int times_ = 1;
  Intrinsics intrinsics_;
  int original_width_ = 0;
  int original_height_ = 0;
  std::vector<float> depth_m_;
  std::vector<std::uint8_t> mask_;
};

}  // namespace flowdlo::path
