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
  Strand front;
  Strand back;
};

/// [height, width] cells, row-major.
class TubeRaster {
 public:
  TubeRaster() = default;
  TubeRaster(int width, int height);

  /// Clears what was drawn before and draws the tube through `points`, each radius larger by
  /// `rim_cells`. Samples of it further apart than `strand_gap_m` along the tube are two strands.
  /// Points are finite, radii above 0.
  void draw(std::span<const TubePoint> points, float radius_m, float rim_cells, float strand_gap_m);

  /// Indices of the cells that hold a strand, each once.
  [[nodiscard]] const std::vector<std::uint32_t>& covered() const { return covered_; }
  [[nodiscard]] const TubeCell& cell(std::size_t index) const { return cells_[index]; }

 private:
  void draw_segment(const TubePoint& from, const TubePoint& to);
  void put(std::size_t index, const Strand& sample);

  int width_ = 0;
  int height_ = 0;
  float radius_m_ = 0;
  float rim_cells_ = 0;
  float strand_gap_m_ = 0;
  std::vector<TubeCell> cells_;
  std::vector<std::uint32_t> covered_;
};

}  // namespace flowdlo::gate
