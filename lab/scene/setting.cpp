#include "scene/setting.hpp"

#include <algorithm>
#include <cmath>

namespace flowdlo::lab {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

Matrix3d turned_about_x(double angle) {
  Matrix3d m;
  m << 1, 0, 0, 0, std::cos(angle), -std::sin(angle), 0, std::sin(angle), std::cos(angle);
  return m;
}

void choose_camera(Random& random, Image& image) {
  const bool large = random.chance(0.25);
  image.width = large ? 1280 : 640;
  image.height = large ? 720 : 480;
  const double focal = image.width * random.uniform(0.7, 1.0);
  image.camera = {static_cast<float>(focal), static_cast<float>(focal),
                  static_cast<float>(0.5 * image.width + random.uniform(-5, 5)),
                  static_cast<float>(0.5 * image.height + random.uniform(-5, 5))};
}

Vector2d project(const Intrinsics& camera, const Vector3d& p) {
  return {camera.fx * p.x() / p.z() + camera.cx, camera.fy * p.y() / p.z() + camera.cy};
}

void measure(Image& image, bool bad, Random& random) {
  const std::vector<float> before = image.depth_m;
  const double flying = bad ? 0.5 : 0.1;
  const double noise = bad ? 0.004 : 0.001;
  for (int v = 1; v + 1 < image.height; ++v) {
    for (int u = 1; u + 1 < image.width; ++u) {
      const std::size_t p = static_cast<std::size_t>(v) * image.width + u;
      if (before[p] <= 0) continue;
      const float left = before[p - 1];
      const float right = before[p + 1];
      if (std::abs(left - right) > 0.008F && random.chance(flying)) {
        const double t = random.uniform(0, 1);
        image.depth_m[p] = static_cast<float>((1 - t) * left + t * right);
      }
      const double z = image.depth_m[p] + noise * before[p] * random.gaussian();
      image.depth_m[p] = static_cast<float>(std::max(0.0, std::round(z * 1000) / 1000));
    }
  }
}

Centerline nodes_of(const Curve3& curve) {
  double length = 0;
  for (std::size_t i = 1; i < curve.size(); ++i) length += (curve[i] - curve[i - 1]).norm();
  const Curve3 even = respaced(curve, length / (kNodes - 1));
  Centerline nodes{};
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Vector3d p = even[std::min(i, even.size() - 1)].cast<double>();
    nodes[i] = {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())};
  }
  return nodes;
}

}  // namespace flowdlo::lab
