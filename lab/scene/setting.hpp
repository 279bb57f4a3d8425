// Setting: what scenes of one rope and of several have in common: camera, sensor and truth.
#pragma once

#include <Eigen/Core>

#include "flowdlo/centerline.hpp"
#include "scene/curve.hpp"
#include "scene/random.hpp"
#include "scene/render.hpp"

namespace flowdlo::lab {

[[nodiscard]] Eigen::Matrix3d turned_about_x(double angle);

/// Gives `image` a size and a camera.
void choose_camera(Random& random, Image& image);

[[nodiscard]] Eigen::Vector2d project(const Intrinsics& camera, const Eigen::Vector3d& p);

/// Flying pixels at depth edges, noise, quantisation to a millimetre.
void measure(Image& image, bool bad, Random& random);

/// 64 nodes of a curve, uniform in arclength.
[[nodiscard]] Centerline nodes_of(const Curve3& curve);

}  // namespace flowdlo::lab
