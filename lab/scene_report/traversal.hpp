// Traversal: whether a path visits a scene's rope in order.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "path/path.hpp"
#include "scene/scene.hpp"

namespace flowdlo::lab {

/// A place of a rope in the image, and how near to it a line has to be.
struct Mark {
  Eigen::Vector2d point_px{0, 0};
  double tolerance_px = 0;
};

/// True when path and marks can be walked together from end to end, never back.
[[nodiscard]] bool visits_in_order(const std::vector<Eigen::Vector2d>& path,
                                   const std::vector<Mark>& marks);

/// The path a perfect tracer would give: the projected centerline, to the mask's tips.
[[nodiscard]] path::Path true_path(const Scene& scene);

/// True when path and projected rope can be walked together from end to end, never back, always
/// within a width of each other (four widths under a bar).
[[nodiscard]] bool follows_rope(const path::Path& path, const Scene& scene);

}  // namespace flowdlo::lab
