#include "synth/look.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "synth/pixel_noise.hpp"

namespace flowdlo::synth {
namespace {

using Eigen::Vector3f;

constexpr std::array<HsvBand, 5> kBands = {{
    {{100, 90, 25}, {120, 255, 255}},
    {{0, 110, 25}, {9, 255, 255}},
    {{48, 90, 25}, {72, 255, 255}},
    {{78, 90, 25}, {97, 255, 255}},
    {{0, 0, 5}, {180, 90, 100}},
}};

const std::array<Material, 5>& materials() {
  static const std::array<Material, 5> all = {{
      {"blue", {205, 85, 20}, kBands[0], false},
      {"red", {25, 35, 205}, kBands[1], false},
      {"green", {40, 165, 40}, kBands[2], false},
      {"cyan-green", {150, 180, 25}, kBands[3], false},
      {"dark-gray", {52, 50, 50}, kBands[4], true},
  }};
  return all;
}

struct Light {
  Vector3f place;
  float ambient = 0.4F;
};

Light draw_light(const View& view, Dice& dice) {
  const double height = view.distance_m * dice.uniform(0.0, 0.5) + dice.uniform(0.1, 0.4);
  return {Vector3d(dice.uniform(-0.6, 0.6), dice.uniform(-0.6, 0.3), -height).cast<float>(),
          static_cast<float>(dice.uniform(0.35, 0.55))};
}

// Ground: a base colour, grain, and on lively grounds planks or patches.
struct Ground {
  Vector3f color;
  float grain = 0.03F;
  float patches = 0;
  float cell_m = 0.05F;
  Vector3f along;
  Vector3f across;
  PixelNoise noise;

  [[nodiscard]] Vector3f at(const Vector3f& p) const {
    const float x = along.dot(p);
    const float y = across.dot(p);
    const float coarse = noise.smooth(x, y, cell_m) - 0.5F;
    const float streak = noise.smooth(x * 0.15F, y, 0.004F) - 0.5F;
    return color * (1 + patches * coarse + grain * streak);
  }
};

Ground draw_ground(const View& view, bool lively, Dice& dice) {
  const double grey = dice.uniform(120, 225);
  const Vector3d plain(grey * dice.uniform(0.9, 1.0), grey * dice.uniform(0.95, 1.0), grey);
  const Vector3d wood = grey * Vector3d(0.55, 0.75, 0.95);
  const Vector3d color = lively && dice.chance(0.4) ? wood : plain;
  const Vector3d normal = view.ground.normal;
  const Vector3d along = normal.cross(Vector3d(0.3, 1, 0.2)).normalized();
  return {color.cast<float>(),
          static_cast<float>(dice.uniform(0.02, 0.12)),
          static_cast<float>(lively ? dice.uniform(0, 0.7) : 0.04),
          static_cast<float>(dice.uniform(0.02, 0.12)),
          along.cast<float>(),
          normal.cross(along).cast<float>(),
          PixelNoise(dice.word())};
}

struct Shader {
  const View& view;
  const Tracer& tracer;
  Light light;

  // Diffuse light with a hard shadow, and a small highlight in white.
  [[nodiscard]] Vector3f shade(const Vector3f& albedo, const Vector3f& point,
                               const Vector3f& normal, float gloss) const {
    const Vector3f way = (light.place - point).normalized();
    const float facing = normal.dot(way);
    float lit = std::max(0.0F, facing);
    const bool dark = lit > 0 && tracer.shadowed(point + 0.0004F * normal, light.place);
    if (dark) lit *= 0.25F;
    const Vector3f halfway = (way - point.normalized()).normalized();
    const float shine = dark ? 0.0F : gloss * std::pow(std::max(0.0F, normal.dot(halfway)), 40.0F);
    return albedo * (light.ambient + (1.05F - light.ambient) * lit) + Vector3f::Constant(shine);
  }
};

/// [height, width]
std::vector<bool> within(std::span<const Window> windows, const View& view) {
  const int width = view.sensor->width;
  const int height = view.sensor->height;
  std::vector<bool> wanted(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (const Window& window : windows) {
    for (int v = std::max(0, window.top); v < std::min(height, window.bottom); ++v) {
      const auto row = wanted.begin() + static_cast<std::ptrdiff_t>(v) * width;
      const int left = std::clamp(window.left, 0, width);
      const int right = std::clamp(window.right, left, width);
      std::fill(row + left, row + right, true);
    }
  }
  return wanted;
}

/// `across` as carried_across has it.
CordPlace place_on(const Curve& curve, const std::vector<Vector3d>& across, const Surface& seen,
                   const Vector3f& point, double radius_m) {
  const auto i = std::min(curve.points.size() - 2, static_cast<std::size_t>(seen.along));
  const Vector3d tangent = (curve.points[i + 1] - curve.points[i]).normalized();
  const Vector3d out = point.cast<double>() - curve.points[i];
  return {seen.strand, static_cast<double>(seen.along) * curve.step_m / radius_m,
          std::atan2(out.dot(tangent.cross(across[i])), out.dot(across[i]))};
}

std::uint8_t byte(float value) {
  return static_cast<std::uint8_t>(std::clamp(value, 0.0F, 255.0F) + 0.5F * (value < 254.0F));
}

}  // namespace

float braid(const Curve& curve, const Surface& seen, const Vector3f& point, double radius_m) {
  const auto& points = curve.points;
  const auto i = std::min(points.size() - 2, static_cast<std::size_t>(seen.along));
  const Vector3d tangent = (points[i + 1] - points[i]).normalized();
  const Vector3d side = tangent.cross(Vector3d::UnitZ()).normalized();
  const Vector3d out = point.cast<double>() - points[i];
  const double angle = std::atan2(out.dot(tangent.cross(side)), out.dot(side));
  const double turns = static_cast<double>(seen.along) * curve.step_m / radius_m;
  return 1.0F + 0.12F * static_cast<float>(weave(turns, angle));
}

const Material& draw_material(Dice& dice) {
  return materials()[static_cast<std::size_t>(dice.integer(0, 4))];
}

std::vector<std::uint8_t> colored(const View& view, const Tracer& tracer, const Picture& picture,
                                  std::span<const Thing> things, std::span<const Rope> ropes,
                                  std::span<const Material* const> materials, bool lively,
                                  std::span<const Window> windows, Dice& dice) {
  const auto width = static_cast<std::size_t>(view.sensor->width);
  const std::size_t pixels = picture.depth_m.size();
  const Shader shader{view, tracer, draw_light(view, dice)};
  const Ground ground = draw_ground(view, lively, dice);
  const PixelNoise noise(dice.word());
  const auto grain = static_cast<float>(dice.uniform(1, lively ? 5 : 2));
  const auto gloss = static_cast<float>(dice.uniform(0, 35));
  const Vector3f ground_normal = view.ground.normal.cast<float>();
  const auto ray_of = [&](std::size_t pixel) {
    return Vector3f((static_cast<float>(pixel % width) - view.camera.cx) / view.camera.fx,
                    (static_cast<float>(pixel / width) - view.camera.cy) / view.camera.fy, 1);
  };
  std::vector<std::vector<Vector3d>> across(ropes.size());
  for (std::size_t k = 0; k < ropes.size(); ++k) {
    if (ropes[k].cord) across[k] = carried_across(view.curves[k]);
  }
  std::vector<Vector3f> image(pixels, Vector3f::Constant(25));
  std::vector<bool> wanted = within(windows, view);
  for (const Surface& seen : picture.surfaces) {
    if (!wanted[seen.pixel]) continue;
    wanted[seen.pixel] = false;  // done
    const Vector3f point = seen.z_m * ray_of(seen.pixel);
    const bool rope = seen.thing == kRopeThing;
    if (rope && ropes[seen.rope].cord) {
      const Cord& cord = *ropes[seen.rope].cord;
      const CordPlace place = place_on(view.curves[seen.rope], across[seen.rope], seen, point,
                                       ropes[seen.rope].radius_m);
      image[seen.pixel] =
          shader.shade(color_at(cord, place), point, seen.normal, static_cast<float>(cord.gloss));
      continue;
    }
    Vector3f albedo =
        (rope ? materials[seen.rope]->color_bgr : things[seen.thing].color_bgr).cast<float>();
    if (rope) albedo *= braid(view.curves[seen.rope], seen, point, ropes[seen.rope].radius_m);
    image[seen.pixel] = shader.shade(albedo, point, seen.normal, rope ? gloss : 0.5F * gloss);
  }
  for (std::size_t i = 0; i < pixels; ++i) {
    if (!wanted[i] || picture.depth_m[i] <= 0) continue;
    const Vector3f point = picture.depth_m[i] * ray_of(i);
    image[i] = shader.shade(ground.at(point), point, ground_normal, 0);
  }
  std::vector<std::uint8_t> bgr(3 * pixels);
  wanted = within(windows, view);
  for (std::size_t i = 0; i < pixels; ++i) {
    if (!wanted[i]) continue;
    const float jitter = grain * noise.bell(static_cast<std::uint32_t>(i), 0);
    for (int k = 0; k < 3; ++k)
      bgr[3 * i + static_cast<std::size_t>(k)] = byte(image[i][k] + jitter);
  }
  return bgr;
}

}  // namespace flowdlo::synth
