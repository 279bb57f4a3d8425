// Overlay: a scene with the true and an estimated centerline as a picture.
#pragma once

#include <string>

#include "prior/prior.hpp"
#include "scene/scene.hpp"

namespace flowdlo::pictures {

/// As eval::error_overlay_png draws a prior with its support. False when `file` cannot be written.
bool save_overlay(const std::string& file, const lab::Scene& scene, const Centerline& truth,
                  const prior::Prior& prior);

}  // namespace flowdlo::pictures
