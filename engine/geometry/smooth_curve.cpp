#include "geometry/smooth_curve.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "geometry/camera.hpp"

namespace flowdlo::geometry {
namespace {

using Eigen::Vector3d;

constexpr int kSteps = 32;  // of a piece, for its arclength

/// Between two neighbouring knots: a cubic of a parameter in [0, 1], in Hermite's form.
struct Piece {
  Vector3d from;
  Vector3d to;
  Vector3d leaves;   // derivative at `from`
  Vector3d arrives;  // derivative at `to`

  [[nodiscard]] Vector3d at(double t) const {
    const double rest = 1 - t;
    return rest * rest * ((1 + 2 * t) * from + t * leaves) +
           t * t * ((1 + 2 * rest) * to - rest * arrives);
  }
};

std::vector<Vector3d> distinct(const Centerline& nodes) {
  std::vector<Vector3d> knots;
  for (const Point3& node : nodes) {
    const Vector3d place = to_eigen(node).cast<double>();
    if (knots.empty() || place != knots.back()) knots.push_back(place);
  }
  return knots;
}

/// [knots] derivatives by centripetal Catmull-Rom: of the parabola through a knot and both its
/// neighbours, over a parameter that grows with the root of their distance. At the ends: of the
/// parabola through the three knots there.
struct Tangents {
  std::vector<Vector3d> at;
  std::vector<double> span;  // of the parameter, one a piece
};

Tangents tangents(const std::vector<Vector3d>& knots) {
  const std::size_t pieces = knots.size() - 1;
  Tangents result;
  std::vector<Vector3d> slope;
  for (std::size_t i = 0; i < pieces; ++i) {
    const Vector3d step = knots[i + 1] - knots[i];
    result.span.push_back(std::sqrt(step.stableNorm()));
    slope.push_back(step / result.span.back());
  }
  if (pieces == 1) return {{slope[0], slope[0]}, result.span};
  result.at.resize(knots.size());
  for (std::size_t i = 1; i < pieces; ++i) {
    const double share = result.span[i] / (result.span[i - 1] + result.span[i]);
    result.at[i] = share * slope[i - 1] + (1 - share) * slope[i];
  }
  result.at.front() = 2 * slope.front() - result.at[1];
  result.at.back() = 2 * slope.back() - result.at[pieces - 1];
  return result;
}

std::vector<Piece> pieces_of(const std::vector<Vector3d>& knots) {
  const Tangents tangent = tangents(knots);
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    const double span = tangent.span[i];
    pieces.push_back({knots[i], knots[i + 1], span * tangent.at[i], span * tangent.at[i + 1]});
  }
  return pieces;
}

/// [pieces * kSteps + 1] length of the curve up to each step.
std::vector<double> lengths_of(const std::vector<Piece>& pieces) {
  std::vector<double> lengths{0};
  Vector3d before = pieces.front().from;
  for (const Piece& piece : pieces) {
    for (int step = 1; step <= kSteps; ++step) {
      const Vector3d place = piece.at(static_cast<double>(step) / kSteps);
      lengths.push_back(lengths.back() + (place - before).stableNorm());
      before = place;
    }
  }
  return lengths;
}

}  // namespace

std::vector<Point3> smooth_curve(const Centerline& nodes, int points) {
  std::vector<Point3> curve(static_cast<std::size_t>(points), nodes.front());
  const std::vector<Vector3d> knots = distinct(nodes);
  if (knots.size() < 2) return curve;
  const std::vector<Piece> pieces = pieces_of(knots);
  const std::vector<double> lengths = lengths_of(pieces);
  std::size_t step = 0;
  for (std::size_t i = 1; i + 1 < curve.size(); ++i) {
    const double length =
        lengths.back() * static_cast<double>(i) / static_cast<double>(curve.size() - 1);
    while (step + 2 < lengths.size() && lengths[step + 1] < length) ++step;
    const double stretch = lengths[step + 1] - lengths[step];
    const double within =
        stretch > 0 ? std::clamp((length - lengths[step]) / stretch, 0.0, 1.0) : 0;
    const double t = (static_cast<double>(step % kSteps) + within) / kSteps;
    curve[i] = to_point(pieces[step / kSteps].at(t).cast<float>());
  }
  curve.back() = nodes.back();
  return curve;
}

}  // namespace flowdlo::geometry
