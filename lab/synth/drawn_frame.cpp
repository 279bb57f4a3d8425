#include "synth/drawn_frame.hpp"

#include <cmath>
#include <utility>

#include "synth/curve.hpp"

namespace flowdlo::synth {
namespace {

using lab::Kind;

constexpr std::uint64_t kDistinctSeed = 0x9E3779B97F4A7C15ULL;
constexpr HsvBand kRed{{0, 100, 20}, {5, 255, 255}};  // of what lab/scene's renderer paints

Defects defects_of(Kind kind) {
  Defects defects;
  defects.gap = defects.bars = kind == Kind::kOccluder;
  defects.touch = kind == Kind::kTouching;
  defects.coil = kind == Kind::kCoil;
  defects.depth_holes = kind == Kind::kBadDepth;
  defects.mask_ragged = kind == Kind::kRagged;
  defects.depth_noise = defects.flying_pixels = true;
  return defects;
}

void measure(const lab::Scene& scene, Meta& meta) {
  const auto& camera = scene.image.camera;
  const Curve curve = respaced(scene.curve, 0.5 * scene.radius_m);
  std::vector<Vector2d> line;
  for (const Vector3d& p : curve.points) {
    line.emplace_back(static_cast<double>(camera.fx) * p.x() / p.z(),
                      static_cast<double>(camera.fy) * p.y() / p.z());
  }
  meta.radius_m = scene.radius_m;
  meta.length_m = curve.length_m();
  meta.least_bend_radius_m = least_bend_radius_m(curve, scene.radius_m);
  meta.crossings = static_cast<int>(crossings(line).size());
  meta.intersection = meta.crossings > 0;
  meta.distance_m = curve.points[curve.points.size() / 2].z();
  meta.width_px = 2 * scene.radius_m * static_cast<double>(camera.fx) / meta.distance_m;
}

/// What a camera without noise would see of these ropes and bars alone.
DenseTruth dense_truth(const std::vector<lab::Body>& bodies, const std::vector<lab::Bar>& bars,
                       const lab::Image& like) {
  const lab::Plane nothing{.normal = Vector3d(0, 0, 1), .offset_m = 1000};
  lab::Image image;
  image.width = like.width;
  image.height = like.height;
  image.camera = like.camera;
  if (bars.empty()) {
    lab::render(bodies, nothing, image);
  } else {
    lab::render(bodies.front().curve, bodies.front().radius_m, nothing, bars, image);
  }
  DenseTruth dense;
  for (const lab::Body& body : bodies) {
    dense.curves.push_back(respaced(body.curve, 0.5 * body.radius_m));
  }
  dense.depth_m = std::move(image.depth_m);
  dense.mask = std::move(image.mask);
  return dense;
}

void take(lab::Image& image, FrameFolder& folder) {
  folder.width = image.width;
  folder.height = image.height;
  folder.intrinsics = image.camera;
  folder.depth_m = std::move(image.depth_m);
  for (float& z : folder.depth_m) {  // as it will be read from disk
    z = static_cast<float>(std::round(static_cast<double>(z) / kDepthScale_m) * kDepthScale_m);
  }
  folder.mask = std::move(image.mask);
  folder.color_bgr = std::move(image.color_bgr);
  folder.instances = std::move(image.instances);
}

}  // namespace

std::uint64_t drawn_seed(Part part, std::uint64_t seed, std::uint64_t index) {
  return seed * kDistinctSeed + index / lab::kKinds +
         (part == Part::kValidation ? kFirstDrawnValidation : 0);
}

SyntheticFrame drawn_frame(Kind kind, std::uint64_t seed, bool dense) {
  lab::Scene scene = lab::make_scene(kind, seed);
  SyntheticFrame result;
  Meta& meta = result.meta;
  meta.scenario = lab::name_of(kind);
  meta.material = "red";
  meta.band = kRed;
  meta.camera = "drawn";
  meta.hanging = kind == Kind::kHanging || kind == Kind::kHangingLoops;
  meta.occluders = static_cast<int>(scene.bars.size());
  meta.defects = defects_of(kind);
  measure(scene, meta);
  result.ropes = {{scene.truth, scene.radius_m, false}};
  if (dense) {
    result.dense = dense_truth({{scene.curve, scene.radius_m}}, scene.bars, scene.image);
  }
  take(scene.image, result.folder);
  result.folder.truth = scene.truth;
  return result;
}

SyntheticFrame drawn_ropes_frame(lab::RopesKind kind, int ropes, std::uint64_t seed, bool dense) {
  lab::RopesScene scene = lab::make_ropes(kind, ropes, seed);
  SyntheticFrame result;
  result.meta.ropes = static_cast<int>(scene.ropes.size());
  std::vector<lab::Body> bodies;
  for (const lab::SeenRope& rope : scene.ropes) {
    result.ropes.push_back({rope.truth, rope.radius_m, rope.closed});
    bodies.push_back({rope.curve, rope.radius_m});
  }
  if (dense) result.dense = dense_truth(bodies, {}, scene.image);
  take(scene.image, result.folder);
  result.folder.truth = scene.ropes.front().truth;
  return result;
}

}  // namespace flowdlo::synth
