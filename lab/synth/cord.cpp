#include "synth/cord.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace flowdlo::synth {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

Vector3d tangent_at(const Curve& curve, std::size_t i) {
  const auto& points = curve.points;
  const std::size_t next = std::min(i + 1, points.size() - 1);
  const std::size_t before = i > 0 ? i - 1 : 0;
  return (points[next] - points[before]).normalized();
}

/// Any hue; cream, white, grey and black oftener than chance would have them.
Vector3d draw_color(Dice& dice) {
  const double value = dice.uniform(35, 235);
  const std::size_t kind = dice.pick({55, 25, 20});
  if (kind == 1)
    return Vector3d(dice.uniform(0.6, 1), dice.uniform(0.85, 1), 1) * dice.uniform(150, 235);
  if (kind == 2) return Vector3d::Constant(dice.uniform(18, 70));
  const double hue = dice.uniform(0, 6);
  const double saturation = dice.uniform(0.2, 0.95);
  const auto channel = [&](double shift) {
    const double away = std::abs(std::fmod(hue + shift, 6.0) - 3) - 1;
    return value * (1 - saturation * (1 - std::clamp(away, 0.0, 1.0)));
  };
  return {channel(2), channel(4), channel(0)};
}

double fraction(double x) { return x - std::floor(x); }

}  // namespace

double Cord::strand_radii() const {
  if (strands < 2) return 1;
  const double half = std::sin(std::numbers::pi / strands);
  return half / (1 + half);
}

double Cord::wound(int k, double along_radii) const {
  const double turns = along_radii / turn_radii * (left_handed ? -1 : 1);
  return kTurn * (turns + static_cast<double>(k) / strands);
}

Cord draw_cord(Dice& dice) {
  Cord cord;
  constexpr std::array<int, 4> kStrands = {1, 2, 3, 4};
  cord.strands = kStrands[dice.pick({32, 32, 23, 13})];
  cord.turn_radii = cord.strands == 2 ? dice.log_uniform(5, 20) : dice.uniform(5.5, 14);
  cord.left_handed = dice.chance(0.3);
  constexpr std::array<Pattern, 4> kPatterns = {Pattern::kBraid, Pattern::kTracers,
                                                Pattern::kSpeckles, Pattern::kBands};
  cord.pattern =
      kPatterns[cord.strands > 1 ? dice.pick({75, 0, 25, 0}) : dice.pick({35, 25, 25, 15})];
  cord.color_bgr = draw_color(dice);
  cord.other_bgr =
      dice.chance(0.5) ? draw_color(dice) : Vector3d(cord.color_bgr * dice.uniform(0.4, 1.6));
  const bool mixed = cord.pattern == Pattern::kTracers || dice.chance(0.35);
  cord.others = mixed ? dice.integer(1, std::max(1, cord.strands - 1)) : 0;
  if (cord.strands == 1) cord.others = dice.integer(1, 3);
  cord.depth = dice.uniform(0.05, 0.4);
  cord.share = dice.uniform(0.1, 0.5);
  cord.spot_radii = dice.log_uniform(0.3, cord.pattern == Pattern::kBands ? 6 : 2);
  cord.gloss = dice.chance(0.3) ? dice.uniform(40, 140) : dice.uniform(0, 35);
  cord.noise = PixelNoise(dice.word());
  return cord;
}

std::vector<Vector3d> carried_across(const Curve& curve) {
  std::vector<Vector3d> across;
  across.reserve(curve.points.size());
  Vector3d last = tangent_at(curve, 0).unitOrthogonal();
  for (std::size_t i = 0; i < curve.points.size(); ++i) {
    const Vector3d tangent = tangent_at(curve, i);
    last = (last - last.dot(tangent) * tangent).normalized();
    across.push_back(last);
  }
  return across;
}

std::vector<std::vector<Vector3d>> strand_axes(const Cord& cord, const Curve& curve,
                                               double radius_m) {
  if (cord.strands < 2) return {curve.points};
  const std::vector<Vector3d> across = carried_across(curve);
  const double out_m = (1 - cord.strand_radii()) * radius_m;
  std::vector<std::vector<Vector3d>> axes;
  for (int k = 0; k < cord.strands; ++k) {
    std::vector<Vector3d> axis;
    for (std::size_t i = 0; i < curve.points.size(); ++i) {
      const double angle = cord.wound(k, static_cast<double>(i) * curve.step_m / radius_m);
      const Vector3d up = tangent_at(curve, i).cross(across[i]);
      axis.push_back(curve.points[i] +
                     out_m * (std::cos(angle) * across[i] + std::sin(angle) * up));
    }
    axes.push_back(std::move(axis));
  }
  return axes;
}

double weave(double along_radii, double angle_rad) {
  return std::sin(along_radii * 1.6 + 3 * angle_rad) * std::sin(along_radii * 1.6 - 3 * angle_rad);
}

Eigen::Vector3f color_at(const Cord& cord, const CordPlace& place) {
  const double along = place.along_radii;
  double other = 0;
  double light = 1;
  if (cord.strands > 1) other = place.strand < cord.others ? 1 : 0;
  switch (cord.pattern) {
    case Pattern::kBraid:
      light += cord.depth * weave(along, place.angle_rad);
      break;
    case Pattern::kTracers: {
      const double turned =
          fraction((place.angle_rad - cord.wound(0, along)) / kTurn * cord.others);
      other = turned < 0.2 * cord.others ? 1 : 0;
      break;
    }
    case Pattern::kSpeckles: {
      const auto spot = static_cast<float>(cord.spot_radii);
      const float shown =
          cord.noise.smooth(static_cast<float>(along), static_cast<float>(place.angle_rad), spot);
      if (static_cast<double>(shown) < cord.share) other = 1 - other;
      break;
    }
    case Pattern::kBands:
      other = fraction(along / (4 * cord.spot_radii)) < cord.share ? 1 : 0;
      break;
  }
  return (light * ((1 - other) * cord.color_bgr + other * cord.other_bgr)).cast<float>();
}

}  // namespace flowdlo::synth
