// Curve: a rope's centerline as dense samples, evenly spaced in arclength, and what can be
// measured on it.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "flowdlo/centerline.hpp"

namespace flowdlo::synth {

using Eigen::Vector2d;
using Eigen::Vector3d;

struct Curve {
  std::vector<Vector3d> points;
  double step_m = 0;  ///< arclength between neighbours

  [[nodiscard]] double length_m() const {
    return points.empty() ? 0 : step_m * static_cast<double>(points.size() - 1);
  }
};

/// Two arclengths, in samples, at which plane curves cross; the sine of the angle.
struct Crossing {
  double first = 0;   ///< of one curve with itself the smaller one
  double second = 0;  ///< and the larger one
  double sine = 1;
};

/// `points` resampled evenly, about `spacing_m` apart; the number of steps is a multiple of four.
[[nodiscard]] Curve respaced(std::span<const Vector3d> points, double spacing_m);

/// Every sample replaced by the mean of those within `reach` samples; the ends stay.
void smooth(std::vector<Vector3d>& points, int reach);

/// Of a plane curve with itself.
[[nodiscard]] std::vector<Crossing> crossings(std::span<const Vector2d> points);
/// Of one plane curve with another: `first` is along `a`, `second` along `b`.
[[nodiscard]] std::vector<Crossing> crossings(std::span<const Vector2d> a,
                                              std::span<const Vector2d> b);

/// Of the circles through samples two radii apart, metres.
[[nodiscard]] double least_bend_radius_m(const Curve& curve, double radius_m);

/// How near strands of one rope come to each other.
struct Nearness {
  double least_m = 0;    ///< distance of two samples over eight radii of arclength apart
  double contact_m = 0;  ///< longest stretch within 2.4 radii of another strand
};

[[nodiscard]] Nearness nearness(const Curve& curve, double radius_m);

/// The least distance of two samples of different curves, metres, where it is below `reach_m`;
/// `reach_m` where it is not.
[[nodiscard]] double distance_m(const Curve& a, const Curve& b, double reach_m);

/// [64, 3] uniform in arclength, Eq. (3.2); direction of Sec. 3.3: the smaller x first, then y, z.
[[nodiscard]] Centerline nodes_of(const Curve& curve);

}  // namespace flowdlo::synth
