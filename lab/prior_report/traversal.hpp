// Traversal: whether a path visits a scene's rope in order.
#pragma once

#include "path/path.hpp"
#include "scene/scene.hpp"

namespace flowdlo::lab {

/// The path a perfect tracer would give: the projected centerline, to the mask's tips.
[[nodiscard]] path::Path true_path(const Scene& scene);

/// True when path and projected rope can be walked together from end to end, never back, always
/// within a width of each other (four widths under a bar).
[[nodiscard]] bool follows_rope(const path::Path& path, const Scene& scene);

}  // namespace flowdlo::lab
