// RopeDepth: how far the rope is around each place of a region.
#pragma once

#include <algorithm>

#include "field/sight.hpp"
#include "image/image.hpp"

namespace flowdlo::field {

/// Smooth: a plane through the medians of the cells of a grid, for each cell its own. Occluders and
/// holes weigh nothing, for they are no mask; a table seen aslant leaves no steps, nor an error at
/// the image's border.
class RopeDepth {
 public:
  explicit RopeDepth(const NearSight& sight);

  /// Whether the mask has no depth at all.
  [[nodiscard]] bool empty() const { return coarse_m_.empty(); }

  /// Row `v` of a block, bilinear between the middles of cells: `row_m` [kBlock_px], metres.
  void row_of(const image::Point& block, int v, float* row_m) const;

 private:
  /// Pixels of a block that lie beyond the region ask for cells that there are none of.
  [[nodiscard]] float cell(int row, int column) const {
    return coarse_m_.at(std::min(row, coarse_m_.height() - 1),
                        std::min(column, coarse_m_.width() - 1));
  }

  image::Image<float> coarse_m_;  // [cells and one around]
};

}  // namespace flowdlo::field
