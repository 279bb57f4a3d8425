// TubeRaster: a centerline drawn as a round tube into a coarse z-buffer that keeps two strands.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace flowdlo::gate {

/// One sample of a centerline as the raster sees it.
struct TubePoint {
  Eigen::Vector3f cam{0, 0, 0};  ///< metres
  Eigen::Vector2f cell{0, 0};    ///< projection, in cells
  float depth_m = 0;             ///< of the axis
  float radius_cells = 0;
  float arclength_m = 0;
};

/// What one strand shows in one cell.
struct Strand {
  float surface_m = 0;    ///< depth of the nearest surface; infinity: the strand is not here
  float arclength_m = 0;  ///< of that surface along the tube
  float off_axis = 0;     ///< distance from the axis in radii, least seen

  [[nodiscard]] bool here() const;
};

/// The nearest strand, and one more where two strands overlap.
struct TubeCell {
  int column = 0;
  int row = 0;
  Strand front;
  Strand back;
};

/// [height, width] cells, of which only those that the tube covers take more than a number.
class TubeRaster {
 public:
  TubeRaster(int width, int height);

  /// Clears what was drawn before and draws the tube through `points`, each radius larger by
  /// `rim_cells`. Samples of it further apart than `strand_gap_m` along the tube are two strands.
  /// Points are finite, radii above 0.
  void draw(std::span<const TubePoint> points, float radius_m, float rim_cells, float strand_gap_m);

  /// The cells that hold a strand, in the order in which they were first drawn to.
  [[nodiscard]] const std::vector<TubeCell>& covered() const { return covered_; }

 private:
  void draw_segment(const TubePoint& from, const TubePoint& to);
  void put(int column, int row, const Strand& sample);
  [[nodiscard]] std::uint32_t& number_at(int column, int row);

  int width_ = 0;
  int height_ = 0;
  float radius_m_ = 0;
  float rim_cells_ = 0;
  float strand_gap_m_ = 0;
  std::vector<std::uint32_t>
      numbers_;  // [height, width] of a covered cell from 1 on; 0: not covered
  std::vector<TubeCell> covered_;
};

}  // namespace flowdlo::gate
