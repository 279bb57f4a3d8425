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

}  // namespace

std::uint64_t drawn_seed(Part part, std::uint64_t seed, std::uint64_t index) {
  return seed * kDistinctSeed + index / lab::kKinds +
         (part == Part::kValidation ? kFirstDrawnValidation : 0);
}

SyntheticFrame drawn_frame(Kind kind, std::uint64_t seed) {
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
  FrameFolder& folder = result.folder;
  folder.width = scene.image.width;
  folder.height = scene.image.height;
  folder.intrinsics = scene.image.camera;
  folder.depth_m = std::move(scene.image.depth_m);
  for (float& z : folder.depth_m) {  // as it will be read from disk
    z = static_cast<float>(std::round(static_cast<double>(z) / kDepthScale_m) * kDepthScale_m);
  }
  folder.mask = std::move(scene.image.mask);
  folder.color_bgr = std::move(scene.image.color_bgr);
  folder.truth = scene.truth;
  return result;
}

}  // namespace flowdlo::synth
