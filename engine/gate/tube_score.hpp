// Render and compare: a centerline drawn as a tube, held against mask and depth.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "flowdlo/centerline.hpp"
#include "flowdlo/frame.hpp"
#include "gate/tube_raster.hpp"
#include "geometry/mask_box.hpp"

namespace flowdlo::gate {

/// Each figure is finite and in its range whatever the centerline; the defaults are the worst.
struct TubeScore {
  float mask_recall = 0;         ///< [0, 1] share of the mask that the tube explains
  float mask_precision = 0;      ///< [0, 1] share of the tube on the mask, hidden parts left out
  float hidden_share = 0;        ///< [0, 1] share behind what is no rope, or unmeasured
  float depth_agreement = 0;     ///< [0, 1] share of measured depths at the front strand's surface
  float depth_bias = 0;          ///< [-1, 1] mean of measured - drawn depth, in tolerances
  float crossing_agreement = 0;  ///< [0, 1] depth_agreement near crossings; 1 without crossings
  float overlap_share = 1;       ///< [0, 1] share of the tube that two strands cover
  float crossings = 0;           ///< [0, 99] of the projected curve with itself
  float least_sine = 0;          ///< [0, 1] of the angle at the flattest crossing; 1 without any
  float least_clearance = 0;     ///< [0, 1] least depth gap at crossings, in diameters; 1 without
  float bending = 99;            ///< [0, 99] radius times the integral of the squared curvature
  float sharpest_bend = 2;       ///< [0, 2] radius times the largest curvature
};

/// What a pixel spans where `nodes` are, metres; 0 where none is in front of the camera.
[[nodiscard]] float pixel_m(const Centerline& nodes, const Intrinsics& camera);

/// What half of `rope_width_px` means in metres where `nodes` are, at most 1.
[[nodiscard]] float tube_radius_m(const Centerline& nodes, const Intrinsics& camera,
                                  float rope_width_px);

/// The side of a frame that hypotheses are compared with. Rasters are coarse: a rope is five to ten
/// cells wide, or as many pixels as it has.
class TubeView {
 public:
  /// Expects a valid frame, whose pixels have to outlive it. `rope_width_px` is path::Traversals'.
  TubeView(const Frame& frame, float rope_width_px);

  /// `tube_radius_m` of the rope's width.
  [[nodiscard]] float radius_m(const Centerline& nodes) const;

  /// Standard deviation of the depths on the mask, as far as neighbours tell it.
  [[nodiscard]] float noise_m() const { return noise_m_; }

  /// The worst score when a node is not finite or not in front of the camera, when the radius is
  /// not positive, or when there is no mask.
  [[nodiscard]] TubeScore score(const Centerline& nodes, float radius_m);

 private:
  void find_region(const image::Rect& mask);
  [[nodiscard]] std::size_t pixel_of(int column, int row) const;
  [[nodiscard]] bool masked(std::size_t pixel) const;
  [[nodiscard]] float depth_m(std::size_t pixel) const;
  void measure_mask();
  void compare(const std::vector<TubePoint>& tube, float radius_m, TubeScore& score);

  Frame frame_;
  float rope_width_px_;
  int stride_px_;
  int left_px_ = 0;
  int top_px_ = 0;
  int width_ = 0;      ///< cells
  int height_ = 0;     ///< cells
  double masked_ = 0;  ///< cells of the mask
  float noise_m_ = 0;
  std::optional<TubeRaster> raster_;  ///< of the last hypothesis; kept for its memory
};

}  // namespace flowdlo::gate
