#include "scene/render.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace flowdlo::lab {
namespace {

using Eigen::Vector3d;

struct Rgb {
  double r;
  double g;
  double b;
};

constexpr Rgb kUsual{215, 40, 35};

void paint(Image& image, std::size_t pixel, const Rgb& color, double light) {
  const auto byte = [&](double value) {
    return static_cast<std::uint8_t>(std::clamp(value * light, 0.0, 255.0));
  };
  image.color_bgr[3 * pixel] = byte(color.b);
  image.color_bgr[3 * pixel + 1] = byte(color.g);
  image.color_bgr[3 * pixel + 2] = byte(color.r);
}

Vector3d ray(const Intrinsics& camera, int u, int v) {
  return {(u - static_cast<double>(camera.cx)) / camera.fx,
          (v - static_cast<double>(camera.cy)) / camera.fy, 1};
}

void draw_background(const Plane& plane, Image& image) {
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      const std::size_t pixel = static_cast<std::size_t>(v) * image.width + u;
      const double along = plane.normal.dot(ray(image.camera, u, v));
      const double z = std::abs(along) > 1e-6 ? plane.offset_m / along : 0;
      image.depth_m[pixel] = z > 0 && z < 20 ? static_cast<float>(z) : 0;
      paint(image, pixel, {150, 155, 160}, 0.85 + 0.15 * std::sin(0.11 * u + 0.07 * v));
    }
  }
}

// The near surface of the ball, where it is the nearest thing so far. `label` 0: of one rope.
void draw_ball(const Vector3d& centre, double radius, const Rgb& color, std::uint16_t label,
               Image& image) {
  if (centre.z() <= 2 * radius) return;
  const double u = image.camera.fx * centre.x() / centre.z() + image.camera.cx;
  const double v = image.camera.fy * centre.y() / centre.z() + image.camera.cy;
  const double reach = 1.2 * radius * std::max(image.camera.fx, image.camera.fy) / centre.z() + 1;
  const int left = std::max(0, static_cast<int>(std::floor(u - reach)));
  const int right = std::min(image.width - 1, static_cast<int>(std::ceil(u + reach)));
  const int top = std::max(0, static_cast<int>(std::floor(v - reach)));
  const int bottom = std::min(image.height - 1, static_cast<int>(std::ceil(v + reach)));
  for (int y = top; y <= bottom; ++y) {
    for (int x = left; x <= right; ++x) {
      const Vector3d d = ray(image.camera, x, y);
      const double a = d.squaredNorm();
      const double b = d.dot(centre);
      const double under = b * b - a * (centre.squaredNorm() - radius * radius);
      if (under < 0) continue;
      const double z = (b - std::sqrt(under)) / a;
      const std::size_t pixel = static_cast<std::size_t>(y) * image.width + x;
      const bool rope = image.mask[pixel] != 0;
      if (rope && z >= image.depth_m[pixel]) continue;
      image.depth_m[pixel] = static_cast<float>(z);
      image.mask[pixel] = 255;
      if (label != 0) image.instances[pixel] = label;
      const Vector3d normal = (d * z - centre) / radius;
      paint(image, pixel, color, std::clamp(0.35 - 0.65 * normal.z(), 0.2, 1.0));
    }
  }
}

void draw_bar(const Bar& bar, Image& image) {
  for (int v = 0; v < image.height; ++v) {
    for (int u = 0; u < image.width; ++u) {
      const double across =
          bar.direction.x() * (v - bar.point_px.y()) - bar.direction.y() * (u - bar.point_px.x());
      if (std::abs(across) > bar.half_width_px) continue;
      const std::size_t pixel = static_cast<std::size_t>(v) * image.width + u;
      image.mask[pixel] = 0;
      image.depth_m[pixel] = static_cast<float>(bar.depth_m);
      paint(image, pixel, {30, 30, 34}, 1.0 - 0.3 * std::abs(across) / bar.half_width_px);
    }
  }
}

void clear(const Plane& background, Image& image) {
  const std::size_t pixels = static_cast<std::size_t>(image.width) * image.height;
  image.depth_m.assign(pixels, 0.0F);
  image.mask.assign(pixels, 0);
  image.color_bgr.assign(3 * pixels, 0);
  draw_background(background, image);
}

}  // namespace

void render(const Curve3& curve, double radius_m, const Plane& background,
            const std::vector<Bar>& bars, Image& image) {
  clear(background, image);
  for (const Vector3d& p : respaced(curve, 0.25 * radius_m)) {
    draw_ball(p, radius_m, kUsual, 0, image);
  }
  for (const Bar& bar : bars) draw_bar(bar, image);
}

void render(const std::vector<Body>& ropes, const Plane& background, Image& image) {
  clear(background, image);
  image.instances.assign(image.mask.size(), 0);
  for (std::size_t i = 0; i < ropes.size(); ++i) {
    const Body& rope = ropes[i];
    const Rgb color{rope.color_rgb.x(), rope.color_rgb.y(), rope.color_rgb.z()};
    for (const Vector3d& p : respaced(rope.curve, 0.25 * rope.radius_m)) {
      draw_ball(p, rope.radius_m, color, static_cast<std::uint16_t>(i + 1), image);
    }
  }
}

}  // namespace flowdlo::lab
