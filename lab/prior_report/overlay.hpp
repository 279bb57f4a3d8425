// Overlay: a scene with the true and an estimated centerline as a picture.
#pragma once

#include <string>

#include "prior/prior.hpp"
#include "scene/scene.hpp"

namespace flowdlo::lab {

/// Left the scene around the rope, enlarged: truth green, estimate red (yellow where unsupported),
/// white lines between nodes of equal index. Right the depths along the nodes. False when `file`
/// cannot be written.
bool save_overlay(const std::string& file, const Scene& scene, const Centerline& truth,
                  const prior::Prior& prior);

}  // namespace flowdlo::lab
