// TubeShape: what a tube tells by itself: where it crosses itself and how sharply it bends.
#pragma once

#include <vector>

#include "flowdlo/centerline.hpp"
#include "gate/tube_raster.hpp"
#include "gate/tube_score.hpp"

namespace flowdlo::gate {

/// Further away than this, in cells, a projection has no place in the image.
inline constexpr float kFarthestCell = 1e5F;

/// A smooth curve through `nodes`, up to two samples a segment; `cell` and `radius_cells` are left
/// open.
[[nodiscard]] std::vector<TubePoint> smooth_tube(const Centerline& nodes);

/// About how many cells the tube covers outside a raster of that size.
[[nodiscard]] double cells_outside(const std::vector<TubePoint>& tube, int width, int height);

/// `crossings`, `least_sine` and `least_clearance`, from the projected axis.
void measure_crossings(const std::vector<TubePoint>& tube, float radius_m, TubeScore& score);

/// `bending` and `sharpest_bend`.
void measure_bends(const Centerline& nodes, float radius_m, TubeScore& score);

}  // namespace flowdlo::gate
