// ProjectedCurve: a centerline on a picture, with the places where it passes over itself.
#pragma once

#include <array>
#include <vector>

#include "flowdlo/centerline.hpp"
#include "flowdlo/frame.hpp"
#include "spot.hpp"

namespace flowdlo::tools {

/// Where two strands cross. A position is an index along the nodes, 0 to 63, with a fraction.
struct Crossing {
  double upper = 0;   ///< position on the strand nearer to the camera
  float depth_m = 0;  ///< of the upper strand there
  float sine = 1;     ///< of the angle between the strands, over 0
};

class ProjectedCurve {
 public:
  /// `zoom` picture pixels stand for one pixel of the camera.
  ProjectedCurve(const Centerline& nodes, const Intrinsics& camera, float zoom);

  /// False when a node lies behind the camera or is not finite: then nothing can be drawn.
  [[nodiscard]] bool drawable() const { return drawable_; }

  [[nodiscard]] const std::array<Spot, kNodes>& nodes_px() const { return nodes_px_; }

  [[nodiscard]] float length_px() const { return length_px_.back(); }

  /// The polyline from position `from` to `to`, both clamped to 0..63.
  [[nodiscard]] std::vector<Spot> piece(double from, double to) const;

  /// The position `distance_px` further along the picture than `position`, clamped to 0..63.
  [[nodiscard]] double advanced(double position, float distance_px) const;

  /// Far ones first, the order in which they are to be drawn.
  [[nodiscard]] std::vector<Crossing> crossings() const;

 private:
  [[nodiscard]] Spot at(double position) const;

  std::array<Spot, kNodes> nodes_px_{};
  std::array<float, kNodes> depth_m_{};
  std::array<float, kNodes> length_px_{};  ///< from the first node to each
  bool drawable_ = true;
};

}  // namespace flowdlo::tools
