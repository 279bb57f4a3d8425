// Rectification: from the image that a lens drew to that of the pinhole camera of Eq. (2.2).
#pragma once

#include <string>

#include "flowdlo/frame.hpp"
#include "flowdlo/result.hpp"
#include "picture.hpp"
#include "recording/bag.hpp"

namespace flowdlo::recording {

class Rectification {
 public:
  /// `rectified`: the images are pinhole images already, and P of the camera info describes them.
  /// Otherwise K and D do: plumb_bob (Brown's), rational_polynomial, equidistant (a fish eye), or
  /// no distortion. Fails with kBadInput, naming `who`.
  [[nodiscard]] static Result<Rectification> create(const CameraMessage& camera, bool rectified,
                                                    const std::string& who);

  /// Of the images that color() and nearest() give: K stays, only D is undone.
  [[nodiscard]] const Intrinsics& intrinsics() const { return intrinsics_; }
  [[nodiscard]] const image::Size& size() const { return size_; }
  /// Pixels between where a point is drawn and where it belongs, at most; 0: nothing is moved.
  [[nodiscard]] double largest_shift_px() const { return largest_shift_px_; }

  /// A place in the image that the lens drew.
  struct Place {
    float u = 0;
    float v = 0;
  };
  /// Where the pixel in column `u` of row `v` comes from.
  [[nodiscard]] Place source(int u, int v) const;

  /// Interpolated; black outside.
  [[nodiscard]] support::Picture color(const support::Picture& image) const;
  /// Of the nearest pixel, for depths and masks: a mean of two depths lies on neither surface. 0
  /// outside.
  [[nodiscard]] image::Image<float> nearest(const image::Image<float>& depth_m) const;
  [[nodiscard]] image::Mask nearest(const image::Mask& mask) const;

 private:
  Intrinsics intrinsics_;
  image::Size size_;
  double largest_shift_px_ = 0;
  image::Image<Place> map_;  // [h, w] where a pixel comes from; empty: from itself
};

}  // namespace flowdlo::recording
