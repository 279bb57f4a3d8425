// Window: a part of a frame at another scale, and the way back from it.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "flowdlo/frame.hpp"
#include "geometry/mask_box.hpp"
#include "path/path.hpp"
#include "path/region.hpp"

namespace flowdlo::path {

struct Window {
  image::Rect part;  ///< of the frame, pixels
  float scale = 1;   ///< pixels of the window for each of the frame

  /// Of the frame with that camera, seen through the window.
  [[nodiscard]] Intrinsics camera(const Intrinsics& frame) const;

  /// Where a place of the frame is in the window.
  [[nodiscard]] Eigen::Vector2f place_of(const Eigen::Vector2f& p) const;

  /// Brings what was traced in the window back to the pixels of a frame of that size: samples again
  /// about a pixel apart, widths in the frame's pixels.
  void restore(Traversals& traversals, const image::Size& frame) const;
  void restore(RopePaths& paths, const image::Size& frame) const;

 private:
  void restore(Path& path, const image::Size& frame) const;
};

/// By how much a mask in that box is reduced to be traced; 1: not at all. A large box is traced in
/// full only where its strokes are thin and no longer than a rope.
[[nodiscard]] int reduction_of(const Frame& frame, const image::Rect& box);

/// A copy of a part of a frame at a whole fraction of its size, for masks too large to be traced as
/// they are.
class Reduced {
 public:
  /// Copies the box and what lies around it; `times` squared pixels become one, which is mask where
  /// half of them are.
  Reduced(const Frame& frame, const image::Rect& box, int times);

  /// Views into this object.
  [[nodiscard]] Frame frame() const;

  /// Pixels of the copy for each of the original, and where a place of the original is in it.
  [[nodiscard]] float scale() const { return window_.scale; }
  [[nodiscard]] Eigen::Vector2f place_of(const Eigen::Vector2f& p) const {
    return window_.place_of(p);
  }

  /// Paths of the original in the copy.
  [[nodiscard]] std::vector<Path> paths_in(std::vector<Path> paths) const {
    for (Path& path : paths) {
      for (Eigen::Vector2f& p : path.points_px) p = place_of(p);
    }
    return paths;
  }

  /// Brings what was traced in the copy back to the pixels of the original.
  void restore(Traversals& traversals) const { window_.restore(traversals, original_); }
  void restore(RopePaths& paths) const { window_.restore(paths, original_); }

 private:
  Window window_;
  image::Size original_;
  Intrinsics camera_;
  image::Image<float> depth_m_;
  image::Mask mask_;
  image::Image<std::uint16_t> instances_;
};

/// `trace(frame, null)`; of a mask that is too large to be traced as it is `trace(copy's frame,
/// copy)`, brought back to the pixels of the frame.
template <class Answer, class Trace>
[[nodiscard]] Result<Answer> trace_reduced(const Frame& frame, const Trace& trace) {
  const image::Rect box = geometry::mask_box(frame);
  const int times = reduction_of(frame, box);
  if (times == 1) return trace(frame, nullptr);
  const Reduced reduced(frame, box, times);
  Result<Answer> result = trace(reduced.frame(), &reduced);
  if (result) reduced.restore(*result);
  return result;
}

}  // namespace flowdlo::path
