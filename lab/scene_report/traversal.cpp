#include "scene_report/traversal.hpp"

#include <algorithm>
#include <cmath>

namespace flowdlo::lab {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

Vector2d project(const Intrinsics& camera, const Vector3d& p) {
  return {camera.fx * p.x() / p.z() + camera.cx, camera.fy * p.y() / p.z() + camera.cy};
}

std::vector<Mark> marks_of(const Scene& scene) {
  std::vector<Mark> marks;
  for (const Vector3d& p : respaced(scene.curve, 0.7 * scene.radius_m)) {
    const Vector2d q = project(scene.image.camera, p);
    const double width = 2 * scene.radius_m * scene.image.camera.fx / p.z();
    const bool barred = std::any_of(scene.bars.begin(), scene.bars.end(), [&](const Bar& bar) {
      const Vector2d d = q - bar.point_px;
      return std::abs(bar.direction.x() * d.y() - bar.direction.y() * d.x()) <
             bar.half_width_px + width;
    });
    marks.push_back({q, (barred ? 4 : 1) * width + 3});
  }
  return marks;
}

}  // namespace

bool visits_in_order(const std::vector<Vector2d>& path, const std::vector<Mark>& marks) {
  std::vector<char> reached(marks.size(), 0);
  for (std::size_t i = 0; i < path.size(); ++i) {
    char diagonal = 0;
    for (std::size_t j = 0; j < marks.size(); ++j) {
      const char above = i > 0 ? reached[j] : 0;
      const char left = j > 0 ? reached[j - 1] : 0;
      const bool from = (i == 0 && j == 0) || above != 0 || left != 0 || diagonal != 0;
      const bool near = (path[i] - marks[j].point_px).norm() <= marks[j].tolerance_px;
      reached[j] = from && near ? 1 : 0;
      diagonal = above;
    }
  }
  return reached.back() != 0;
}

path::Path true_path(const Scene& scene) {
  Curve3 curve = respaced(scene.curve, 0.2 * scene.radius_m);
  const Vector3d front = (curve[0] - curve[2]).normalized() * scene.radius_m;
  const Vector3d back = (curve.back() - curve[curve.size() - 3]).normalized() * scene.radius_m;
  curve.insert(curve.begin(), curve.front() + front);
  curve.push_back(curve.back() + back);
  path::Path path;
  for (const Vector3d& p : curve) {
    path.points_px.push_back(project(scene.image.camera, p).cast<float>());
  }
  path.bridged.assign(path.points_px.size(), 0);
  return path;
}

bool follows_rope(const path::Path& path, const Scene& scene) {
  std::vector<Vector2d> points;
  for (std::size_t i = 0; i < path.points_px.size(); i += 2) {
    points.push_back(path.points_px[i].cast<double>());
  }
  points.push_back(path.points_px.back().cast<double>());
  const std::vector<Mark> marks = marks_of(scene);
  if (visits_in_order(points, marks)) return true;
  std::reverse(points.begin(), points.end());
  return visits_in_order(points, marks);
}

}  // namespace flowdlo::lab
