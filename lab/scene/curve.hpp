// Curve: smooth random ropes as dense 3D polylines, strands nowhere nearer than ropes can be.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "scene/random.hpp"

namespace flowdlo::lab {

using Curve2 = std::vector<Eigen::Vector2d>;
using Curve3 = std::vector<Eigen::Vector3d>;

/// What a rope's shape has to be like.
struct Shape {
  double length_m = 0.8;
  double radius_m = 0.004;
  double wander = 1.0;  ///< how far its heading swings, in turns to both sides
  int least_crossings = 0;
  int most_crossings = 0;
};

/// Two arclengths (m) at which a plane curve crosses itself, and the sine of the angle.
struct Crossing {
  double first_m = 0;
  double second_m = 0;
  double sine = 1;
};

/// Samples are spaced evenly, about half a radius apart. Origin: the curve's middle.
[[nodiscard]] std::vector<Crossing> crossings(const Curve2& curve);

/// A plane curve of that shape; away from its crossings no two strands come nearer than 2.8
/// radii. Empty when a few hundred attempts found none.
[[nodiscard]] std::optional<Curve2> wandering(const Shape& shape, Random& random);

/// Two strands side by side, touching, with a turn at one end.
[[nodiscard]] Curve2 hairpin(const Shape& shape, Random& random);

/// A flat spiral of two to three turns, its inner end inside.
[[nodiscard]] Curve2 coil(const Shape& shape, Random& random);

/// `flat` laid on the plane z = 0 seen from negative z: one strand of each crossing is lifted over
/// the other.
[[nodiscard]] Curve3 laid(const Curve2& flat, double radius_m, Random& random);

/// `flat` in free air: z swings along it.
[[nodiscard]] Curve3 floated(const Curve2& flat, double swing_m, Random& random);

/// The least distance of strands that are no neighbours, metres.
[[nodiscard]] double separation(const Curve3& curve, double radius_m);

/// Evenly spaced samples, `spacing_m` apart.
[[nodiscard]] Curve3 respaced(const Curve3& curve, double spacing_m);

}  // namespace flowdlo::lab
