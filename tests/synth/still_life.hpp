// StillLife: a straight rope over a table, seen from above, for the tests of sensor and segmenter.
#pragma once

#include <gtest/gtest.h>

#include "synth/tracer.hpp"

namespace flowdlo::synth::test {

struct StillLife {
  Sensor sensor;
  Rope rope;
  View view;
  Picture picture;

  [[nodiscard]] std::span<const Rope> ropes() const { return {&rope, 1}; }
};

/// 320 x 240 px, focal length 300 px; the rope lies across the image, 12 px wide, on a table
/// `distance_m` away and a radius behind its axis.
inline void arrange(StillLife& scene, double distance_m, DepthPrinciple principle) {
  scene.sensor = {"test", 320, 240, 300, principle, 0.05, 0.08, 0.0015, 0.2, 6.0, 1};
  scene.rope.radius_m = 6 * distance_m / 300;
  scene.view.sensor = &scene.sensor;
  scene.view.camera = {300, 300, 159.5F, 119.5F};
  scene.view.distance_m = distance_m;
  scene.view.ground = {{0, 0, -1}, -(distance_m + scene.rope.radius_m)};
  const double half = 100 * distance_m / 300;
  const std::vector<Vector3d> ends = {{-half, 0, distance_m}, {half, 0, distance_m}};
  scene.view.curves = {respaced(ends, 0.5 * scene.rope.radius_m)};
  const auto tracer = Tracer::create(scene.view, scene.ropes(), {});
  ASSERT_TRUE(tracer) << tracer.error().message;
  scene.picture = tracer->take_picture();
}

}  // namespace flowdlo::synth::test
