#include "scene/scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "scene/setting.hpp"

namespace flowdlo::lab {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr std::array<std::string_view, kKinds> kNames{
    "simple", "hanging", "one-crossing", "many-crossings", "hanging-loops", "occluder",
    "thin",   "ragged",  "bad-depth",    "touching",       "coil"};
constexpr double kSeparation = 1.95;  // radii between strands in space

bool in_air(Kind kind, Random& random) {
  if (kind == Kind::kHanging || kind == Kind::kHangingLoops) return true;
  const bool either = kind == Kind::kOccluder || kind == Kind::kThin || kind == Kind::kRagged ||
                      kind == Kind::kBadDepth;
  return either && random.chance(0.4);
}

Shape shape_of(Kind kind, Random& random) {
  Shape shape;
  shape.length_m = random.uniform(0.5, 1.1);
  shape.radius_m = random.uniform(0.003, 0.007);
  switch (kind) {
    case Kind::kSimple:
    case Kind::kHanging:
      shape.wander = random.uniform(0.1, 0.5);
      break;
    case Kind::kOneCrossing:
      shape.wander = 0.8;
      shape.least_crossings = shape.most_crossings = 1;
      break;
    case Kind::kManyCrossings:
      shape.wander = 1.3;
      shape.length_m = random.uniform(0.8, 1.5);
      shape.least_crossings = shape.most_crossings = random.integer(2, 6);
      break;
    case Kind::kHangingLoops:
      shape.wander = 0.9;
      shape.least_crossings = 1;
      shape.most_crossings = 2;
      break;
    case Kind::kOccluder:
    case Kind::kRagged:
    case Kind::kBadDepth:
      shape.wander = random.uniform(0.3, 0.9);
      shape.most_crossings = 2;
      break;
    case Kind::kThin:
      shape.wander = random.uniform(0.3, 1.0);
      shape.most_crossings = 2;
      shape.radius_m = random.uniform(0.0012, 0.003);
      break;
    case Kind::kTouching:
    case Kind::kCoil:
      break;
  }
  return shape;
}

struct Rope {
  Curve3 curve;
  double radius_m;
  bool air;
};

// Draws shapes until one keeps its strands apart.
Rope make_rope(Kind kind, Random& random) {
  while (true) {
    const Shape shape = shape_of(kind, random);
    const bool air = in_air(kind, random);
    std::optional<Curve2> flat;
    if (kind == Kind::kTouching) {
      flat = hairpin(shape, random);
    } else if (kind == Kind::kCoil) {
      flat = coil(shape, random);
    } else {
      flat = wandering(shape, random);
    }
    if (!flat) continue;
    Curve3 curve = air ? floated(*flat, random.uniform(0.04, 0.2), random)
                       : laid(*flat, shape.radius_m, random);
    curve = respaced(curve, 0.5 * shape.radius_m);
    if (separation(curve, shape.radius_m) < kSeparation * shape.radius_m) continue;
    return {std::move(curve), shape.radius_m, air};
  }
}

// Places the rope in front of the camera so that it fills most of the image. False when it does
// not fit.
bool place(Rope& rope, double tilt, double distance, const Image& image) {
  const Matrix3d turn = turned_about_x(tilt);
  for (Vector3d& p : rope.curve) {
    p = turn * p + Vector3d(0, 0, distance);
    const double margin = 3 + 2 * rope.radius_m * image.camera.fx / std::max(p.z(), 0.05);
    if (p.z() < 0.2) return false;
    const Vector2d q = project(image.camera, p);
    if (q.x() < margin || q.y() < margin || q.x() > image.width - margin ||
        q.y() > image.height - margin) {
      return false;
    }
  }
  return true;
}

double least_distance(const Rope& rope, const Image& image) {
  double need = 0.3;
  for (const Vector3d& p : rope.curve) {
    need = std::max({need, std::abs(p.x()) * image.camera.fx / (0.44 * image.width) - p.z(),
                     std::abs(p.y()) * image.camera.fy / (0.44 * image.height) - p.z()});
  }
  return need;
}

// Bars through random points of the rope; none of them hides an end.
std::vector<Bar> make_bars(const Rope& rope, const Image& image, Random& random) {
  std::vector<Bar> bars;
  const int count = random.integer(1, 2);
  const Vector2d first = project(image.camera, rope.curve.front());
  const Vector2d last = project(image.camera, rope.curve.back());
  const double width_px = 2 * rope.radius_m * image.camera.fx / rope.curve.front().z();
  double nearest = rope.curve.front().z();
  for (const Vector3d& p : rope.curve) nearest = std::min(nearest, p.z());
  for (int tries = 0; tries < 40 && static_cast<int>(bars.size()) < count; ++tries) {
    Bar bar;
    const auto at = static_cast<std::size_t>(random.uniform(0.15, 0.85) *
                                             static_cast<double>(rope.curve.size()));
    bar.point_px = project(image.camera, rope.curve[at]);
    const double angle = random.uniform(0, std::numbers::pi);
    bar.direction = {std::cos(angle), std::sin(angle)};
    bar.half_width_px = random.uniform(0.8, 2.5) * width_px;
    bar.depth_m = nearest - 0.05;
    const auto clear = [&](const Vector2d& p) {
      const Vector2d d = p - bar.point_px;
      return std::abs(bar.direction.x() * d.y() - bar.direction.y() * d.x()) >
             bar.half_width_px + 3 * width_px;
    };
    if (clear(first) && clear(last)) bars.push_back(bar);
  }
  return bars;
}

double lit(const Image& image) {
  return static_cast<double>(std::count(image.mask.begin(), image.mask.end(), 255));
}

// The mask grows by up to `reach` pixels where a smooth random field says so.
void fray(Image& image, int reach, Random& random) {
  const std::vector<std::uint8_t> before = image.mask;
  std::vector<std::array<double, 3>> waves;
  for (int k = 0; k < 6; ++k) {
    waves.push_back({random.uniform(-0.9, 0.9), random.uniform(-0.9, 0.9), random.uniform(0, 7)});
  }
  for (int v = reach; v + reach < image.height; ++v) {
    for (int u = reach; u + reach < image.width; ++u) {
      if (before[static_cast<std::size_t>(v) * image.width + u] == 0) continue;
      double field = 0;
      for (const auto& w : waves) field += std::sin(w[0] * u + w[1] * v + w[2]);
      const int grow = static_cast<int>(std::lround(0.5 * reach * (1 + field / 2.5)));
      for (int dv = -grow; dv <= grow; ++dv) {
        for (int du = -grow; du <= grow; ++du) {
          if (du * du + dv * dv > grow * grow) continue;
          if (std::abs(dv) > reach || std::abs(du) > reach) continue;
          image.mask[static_cast<std::size_t>(v + dv) * image.width + u + du] = 255;
        }
      }
    }
  }
}

void spoil_border(Image& image, Random& random) {
  const std::vector<std::uint8_t> before = image.mask;
  for (int v = 1; v + 1 < image.height; ++v) {
    for (int u = 1; u + 1 < image.width; ++u) {
      const std::size_t p = static_cast<std::size_t>(v) * image.width + u;
      const bool edge =
          before[p - 1] != before[p + 1] || before[p - image.width] != before[p + image.width];
      if (edge && random.chance(0.2)) image.mask[p] = random.chance(0.5) ? 255 : 0;
    }
  }
}

void make_holes(Image& image, const Rope& rope, Random& random) {
  const int count = random.integer(2, 7);
  for (int k = 0; k < count; ++k) {
    const auto at =
        static_cast<std::size_t>(random.uniform(0, static_cast<double>(rope.curve.size())));
    const Vector2d centre = project(image.camera, rope.curve[at]);
    const double reach = random.uniform(5, 30);
    for (int v = static_cast<int>(centre.y() - reach); v < centre.y() + reach; ++v) {
      for (int u = static_cast<int>(centre.x() - reach); u < centre.x() + reach; ++u) {
        if (u < 0 || v < 0 || u >= image.width || v >= image.height) continue;
        if ((Vector2d(u, v) - centre).norm() > reach) continue;
        image.depth_m[static_cast<std::size_t>(v) * image.width + u] = 0;
      }
    }
  }
}

Plane background_of(const Rope& rope, double tilt, double distance) {
  Plane plane;
  if (rope.air) {
    plane.offset_m = distance + 1.5;
    return plane;
  }
  plane.normal = turned_about_x(tilt) * Vector3d(0, 0, 1);
  plane.offset_m = plane.normal.dot(Vector3d(0, 0, distance)) + rope.radius_m;
  return plane;
}

// The rope's width in the image decides how far a thin one is away.
double distance_of(Kind kind, const Rope& rope, const Image& image, Random& random) {
  const double least = least_distance(rope, image);
  if (kind != Kind::kThin) return least * random.uniform(1.05, 1.5);
  const double width_px = random.uniform(2, 8);
  return std::max(1.05 * least, 2 * rope.radius_m * image.camera.fx / width_px);
}

bool attempt(Kind kind, Random& random, Scene& scene) {
  Rope rope = make_rope(kind, random);
  choose_camera(random, scene.image);
  const double tilt = rope.air ? random.uniform(-0.3, 0.3) : random.uniform(-0.5, 0.5);
  const double distance = distance_of(kind, rope, scene.image, random);
  if (!place(rope, tilt, distance, scene.image)) return false;
  const Plane plane = background_of(rope, tilt, distance);
  scene.bars.clear();
  if (kind == Kind::kOccluder) {
    render(rope.curve, rope.radius_m, plane, {}, scene.image);
    const double whole = lit(scene.image);
    scene.bars = make_bars(rope, scene.image, random);
    if (scene.bars.empty()) return false;
    render(rope.curve, rope.radius_m, plane, scene.bars, scene.image);
    if (lit(scene.image) < 0.75 * whole) return false;
  } else {
    render(rope.curve, rope.radius_m, plane, {}, scene.image);
  }
  if (kind == Kind::kRagged) {
    fray(scene.image, random.integer(1, 3), random);
    spoil_border(scene.image, random);
  }
  measure(scene.image, kind == Kind::kBadDepth, random);
  if (kind == Kind::kBadDepth) make_holes(scene.image, rope, random);
  scene.truth = nodes_of(rope.curve);
  scene.radius_m = rope.radius_m;
  scene.curve = std::move(rope.curve);
  return true;
}

}  // namespace

std::string_view name_of(Kind kind) { return kNames[static_cast<std::size_t>(kind)]; }

std::span<const std::string_view> kind_names() { return kNames; }

std::optional<Kind> kind_of(std::string_view name) {
  for (int i = 0; i < kKinds; ++i) {
    if (kNames[static_cast<std::size_t>(i)] == name) return static_cast<Kind>(i);
  }
  return std::nullopt;
}

Scene make_scene(Kind kind, std::uint64_t seed) {
  Random random(seed * kKinds + static_cast<std::uint64_t>(kind));
  Scene scene;
  scene.kind = kind;
  while (!attempt(kind, random, scene)) {
  }
  return scene;
}

}  // namespace flowdlo::lab
