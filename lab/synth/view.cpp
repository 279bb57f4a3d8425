#include "synth/view.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace flowdlo::synth {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
constexpr double kPi = std::numbers::pi;
constexpr double kMargin = 0.95;  // of half the image that the rope may fill
constexpr double kThinnest_px = 2.0;
constexpr double kSmallest = 0.15;  // extent of the rope, in widths of the image

struct Range {
  double low;
  double high;
};

struct Wish {
  Range distance_m;
  double looseness = 1.6;  ///< up to this many times the least distance
  double overflow = 1.0;   ///< below 1: the camera is nearer than the rope's extent wants
};

// Table: seen from above, z towards the camera. Hanging: as it is, y downwards.
Matrix3d facing(const Rope& rope) {
  if (rope.hanging) return Matrix3d::Identity();
  return Vector3d(1, -1, -1).asDiagonal();
}

/// Calls visit(point, curve's index) for every sample.
template <class Visit>
void for_each_point(const std::vector<Curve>& curves, Visit visit) {
  for (std::size_t k = 0; k < curves.size(); ++k) {
    for (const Vector3d& p : curves[k].points) visit(p, k);
  }
}

Vector3d middle_of(const std::vector<Curve>& curves) {
  Vector3d low = curves.front().points.front();
  Vector3d high = low;
  for_each_point(curves, [&](const Vector3d& p, std::size_t) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  });
  return 0.5 * (low + high);
}

double farthest_m(const View& view) {
  double farthest = 0;
  for_each_point(view.curves,
                 [&](const Vector3d& p, std::size_t) { farthest = std::max(farthest, p.z()); });
  return farthest;
}

void move(View& view, const Vector3d& by) {
  view.shift += by;
  for (Curve& curve : view.curves) {
    for (Vector3d& p : curve.points) p += by;
  }
}

// Turns the ropes, and puts the middle of their extent onto the optical axis.
void orient(std::span<const Rope> ropes, const Matrix3d& turn, View& view) {
  view.turn = turn;
  for (const Rope& rope : ropes) {
    view.curves.push_back(rope.curve);
    for (Vector3d& p : view.curves.back().points) p = turn * p;
  }
  move(view, -middle_of(view.curves));
}

double half_px(float centre, int size) {
  return std::min<double>(centre, size - 1 - static_cast<double>(centre));
}

// The least distance at which every sample with its thickness lies within the image.
double least_distance(const View& view, std::span<const Rope> ropes) {
  const double half_u = kMargin * half_px(view.camera.cx, view.sensor->width);
  const double half_v = kMargin * half_px(view.camera.cy, view.sensor->height);
  double need = 0;
  for_each_point(view.curves, [&](const Vector3d& p, std::size_t k) {
    const double radius_m = ropes[k].radius_m;
    need = std::max({need, (std::abs(p.x()) + radius_m) * view.camera.fx / half_u - p.z(),
                     (std::abs(p.y()) + radius_m) * view.camera.fy / half_v - p.z()});
  });
  return need;
}

// Where along one image axis the ropes may be moved without leaving the image.
Range slack(const View& view, int axis, std::span<const Rope> ropes) {
  const double focal = axis == 0 ? view.camera.fx : view.camera.fy;
  const double half = kMargin * (axis == 0 ? half_px(view.camera.cx, view.sensor->width)
                                           : half_px(view.camera.cy, view.sensor->height));
  Range range{-1e9, 1e9};
  for_each_point(view.curves, [&](const Vector3d& p, std::size_t k) {
    const double room = half * p.z() / focal - ropes[k].radius_m;
    range.low = std::max(range.low, -room - p[axis]);
    range.high = std::min(range.high, room - p[axis]);
  });
  return range;
}

// The diagonal of the ropes' picture, in widths of the image.
double extent(const View& view) {
  Vector2d low(1e9, 1e9);
  Vector2d high(-1e9, -1e9);
  for_each_point(view.curves, [&](const Vector3d& p, std::size_t) {
    const Vector2d at = view.project(p);
    low = low.cwiseMin(at);
    high = high.cwiseMax(at);
  });
  return (high - low).norm() / view.sensor->width;
}

bool stand_back(std::span<const Rope> ropes, const Wish& wish, Dice& dice, View& view) {
  const auto [thinnest, thickest] =
      std::minmax_element(ropes.begin(), ropes.end(),
                          [](const Rope& a, const Rope& b) { return a.radius_m < b.radius_m; });
  const double need = wish.overflow * least_distance(view, ropes);
  const double low = std::max(need, wish.distance_m.low);
  const double high = std::min(wish.looseness * low, wish.distance_m.high);
  if (low > high) return false;
  view.distance_m = dice.uniform(low, high);
  move(view, Vector3d(0, 0, view.distance_m));
  double nearest = view.distance_m;
  for_each_point(view.curves,
                 [&](const Vector3d& p, std::size_t) { nearest = std::min(nearest, p.z()); });
  if (nearest < 0.6 * wish.distance_m.low || nearest < 6 * thickest->radius_m) return false;
  for (int axis = 0; axis < 2; ++axis) {
    const Range range = slack(view, axis, ropes);
    if (range.low >= range.high) continue;
    Vector3d by = Vector3d::Zero();
    by[axis] = dice.uniform(0.85 * range.low, 0.85 * range.high);
    move(view, by);
  }
  return 2 * thinnest->radius_m * view.camera.fx / view.distance_m >= kThinnest_px &&
         extent(view) >= kSmallest;
}

void add_table(const Rope& rope, View& view) {
  view.ground.normal = view.turn * Vector3d(0, 0, rope.hanging ? -1 : 1);
  view.ground.offset_m = view.ground.normal.dot(view.shift);
}

// Behind hanging ropes: a wall, or nothing in reach.
void add_wall(Dice& dice, View& view) {
  view.has_ground = dice.chance(0.8);
  const double farthest = farthest_m(view);
  const Matrix3d lean = (AngleAxisd(dice.uniform(-0.3, 0.3), Vector3d::UnitY()) *
                         AngleAxisd(dice.uniform(-0.2, 0.2), Vector3d::UnitX()))
                            .toRotationMatrix();
  view.ground.normal = lean * Vector3d(0, 0, -1);
  const Vector3d point(0, 0, farthest + dice.log_uniform(0.15, 2.5));
  view.ground.offset_m = view.ground.normal.dot(point);
}

bool ground_is_behind(std::span<const Rope> ropes, const View& view) {
  bool behind = true;
  for_each_point(view.curves, [&](const Vector3d& p, std::size_t k) {
    behind = behind && view.ground.normal.dot(p) - view.ground.offset_m >= 0.9 * ropes[k].radius_m;
  });
  return behind || !view.has_ground;
}

// What stands behind the ropes; empty where it would cut through one of them.
std::optional<View> with_ground(std::span<const Rope> ropes, View view, Dice& dice) {
  if (ropes.front().hanging) {
    add_wall(dice, view);
  } else {
    add_table(ropes.front(), view);
  }
  if (!ground_is_behind(ropes, view)) return std::nullopt;
  return view;
}

// Any of the sensors, tilted by up to 70 degrees; its distance is still to be chosen.
View tilted(std::span<const Rope> ropes, Dice& dice) {
  const Rope& rope = ropes.front();
  View view;
  view.sensor = &draw_sensor(dice);
  view.camera = intrinsics_of(*view.sensor, dice);
  const double most_tilt = kPi * 70 / 180;
  view.tilt_rad = dice.chance(0.3) ? dice.uniform(0, 0.2) : dice.uniform(0, most_tilt);
  const Matrix3d roll = AngleAxisd(dice.uniform(-0.25, 0.25), Vector3d::UnitZ()).matrix();
  const Vector3d hinge = rope.hanging && dice.chance(0.7) ? Vector3d::UnitY() : Vector3d::UnitX();
  const double angle = rope.hanging ? dice.sign() * view.tilt_rad : -view.tilt_rad;
  Matrix3d turn = roll * AngleAxisd(angle, hinge).matrix() * facing(rope);
  if (!rope.hanging) turn = turn * AngleAxisd(dice.uniform(-kPi, kPi), Vector3d::UnitZ()).matrix();
  orient(ropes, turn, view);
  return view;
}

}  // namespace

std::optional<View> try_thesis_view(std::span<const Rope> ropes, Dice& dice) {
  View view;
  view.sensor = &thesis_sensor();
  view.camera = intrinsics_of(*view.sensor, dice);
  view.tilt_rad = dice.uniform(0, 0.26);
  const Matrix3d turn = AngleAxisd(-view.tilt_rad, Vector3d::UnitX()) * facing(ropes.front()) *
                        AngleAxisd(dice.uniform(-kPi, kPi), Vector3d::UnitZ());
  orient(ropes, turn, view);
  if (!stand_back(ropes, {.distance_m = {0.3, 0.5}}, dice, view)) return std::nullopt;
  add_table(ropes.front(), view);
  return view;
}

std::optional<View> try_wide_view(std::span<const Rope> ropes, Dice& dice) {
  View view = tilted(ropes, dice);
  Wish wish{.distance_m = {std::max(0.25, view.sensor->nearest_m), 1.5},
            .looseness = dice.uniform(1.1, 2.0)};
  if (dice.chance(0.08)) wish = {wish.distance_m, 1.02, dice.uniform(0.8, 0.95)};
  if (!stand_back(ropes, wish, dice, view)) return std::nullopt;
  return with_ground(ropes, std::move(view), dice);
}

std::optional<View> try_near_view(std::span<const Rope> ropes, Dice& dice) {
  View view = tilted(ropes, dice);
  const Wish wish{.distance_m = {std::max(0.25, view.sensor->nearest_m), 1.5},
                  .looseness = 1.02,
                  .overflow = dice.uniform(0.5, 0.8)};
  if (!stand_back(ropes, wish, dice, view)) return std::nullopt;
  return with_ground(ropes, std::move(view), dice);
}

}  // namespace flowdlo::synth
