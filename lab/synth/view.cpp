#include "synth/view.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

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

Vector3d middle_of(const Curve& curve) {
  Vector3d low = curve.points.front();
  Vector3d high = low;
  for (const Vector3d& p : curve.points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return 0.5 * (low + high);
}

// Turns the rope, and puts the middle of its extent onto the optical axis.
void orient(const Rope& rope, const Matrix3d& turn, View& view) {
  view.turn = turn;
  view.curve = rope.curve;
  for (Vector3d& p : view.curve.points) p = turn * p;
  view.shift = -middle_of(view.curve);
  for (Vector3d& p : view.curve.points) p += view.shift;
}

double half_px(float centre, int size) {
  return std::min<double>(centre, size - 1 - static_cast<double>(centre));
}

// The least distance at which every sample with its thickness lies within the image.
double least_distance(const View& view, double radius_m) {
  const double half_u = kMargin * half_px(view.camera.cx, view.sensor->width);
  const double half_v = kMargin * half_px(view.camera.cy, view.sensor->height);
  double need = 0;
  for (const Vector3d& p : view.curve.points) {
    need = std::max({need, (std::abs(p.x()) + radius_m) * view.camera.fx / half_u - p.z(),
                     (std::abs(p.y()) + radius_m) * view.camera.fy / half_v - p.z()});
  }
  return need;
}

// Where along one image axis the rope may be moved without leaving the image.
Range slack(const View& view, int axis, double radius_m) {
  const double focal = axis == 0 ? view.camera.fx : view.camera.fy;
  const double half = kMargin * (axis == 0 ? half_px(view.camera.cx, view.sensor->width)
                                           : half_px(view.camera.cy, view.sensor->height));
  Range range{-1e9, 1e9};
  for (const Vector3d& p : view.curve.points) {
    const double room = half * p.z() / focal - radius_m;
    range.low = std::max(range.low, -room - p[axis]);
    range.high = std::min(range.high, room - p[axis]);
  }
  return range;
}

void move(View& view, const Vector3d& by) {
  view.shift += by;
  for (Vector3d& p : view.curve.points) p += by;
}

// The diagonal of the rope's picture, in widths of the image.
double extent(const View& view) {
  Vector2d low(1e9, 1e9);
  Vector2d high(-1e9, -1e9);
  for (const Vector3d& p : view.curve.points) {
    const Vector2d at = view.project(p);
    low = low.cwiseMin(at);
    high = high.cwiseMax(at);
  }
  return (high - low).norm() / view.sensor->width;
}

bool stand_back(const Rope& rope, const Wish& wish, Dice& dice, View& view) {
  const double need = wish.overflow * least_distance(view, rope.radius_m);
  const double low = std::max(need, wish.distance_m.low);
  const double high = std::min(wish.looseness * low, wish.distance_m.high);
  if (low > high) return false;
  view.distance_m = dice.uniform(low, high);
  move(view, Vector3d(0, 0, view.distance_m));
  double nearest = view.distance_m;
  for (const Vector3d& p : view.curve.points) nearest = std::min(nearest, p.z());
  if (nearest < 0.6 * wish.distance_m.low || nearest < 6 * rope.radius_m) return false;
  for (int axis = 0; axis < 2; ++axis) {
    const Range range = slack(view, axis, rope.radius_m);
    if (range.low >= range.high) continue;
    Vector3d by = Vector3d::Zero();
    by[axis] = dice.uniform(0.85 * range.low, 0.85 * range.high);
    move(view, by);
  }
  return 2 * rope.radius_m * view.camera.fx / view.distance_m >= kThinnest_px &&
         extent(view) >= kSmallest;
}

void add_table(const Rope& rope, View& view) {
  view.ground.normal = view.turn * Vector3d(0, 0, rope.hanging ? -1 : 1);
  view.ground.offset_m = view.ground.normal.dot(view.shift);
}

// Behind a hanging rope: a wall, or nothing in reach.
void add_wall(Dice& dice, View& view) {
  view.has_ground = dice.chance(0.8);
  double farthest = 0;
  for (const Vector3d& p : view.curve.points) farthest = std::max(farthest, p.z());
  const Matrix3d lean = (AngleAxisd(dice.uniform(-0.3, 0.3), Vector3d::UnitY()) *
                         AngleAxisd(dice.uniform(-0.2, 0.2), Vector3d::UnitX()))
                            .toRotationMatrix();
  view.ground.normal = lean * Vector3d(0, 0, -1);
  const Vector3d point(0, 0, farthest + dice.log_uniform(0.15, 2.5));
  view.ground.offset_m = view.ground.normal.dot(point);
}

bool ground_is_behind(const Rope& rope, const View& view) {
  return !view.has_ground ||
         std::none_of(view.curve.points.begin(), view.curve.points.end(), [&](const Vector3d& p) {
           return view.ground.normal.dot(p) - view.ground.offset_m < 0.9 * rope.radius_m;
         });
}

}  // namespace

std::optional<View> try_thesis_view(const Rope& rope, Dice& dice) {
  View view;
  view.sensor = &thesis_sensor();
  view.camera = intrinsics_of(*view.sensor, dice);
  view.tilt_rad = dice.uniform(0, 0.26);
  const Matrix3d turn = AngleAxisd(-view.tilt_rad, Vector3d::UnitX()) * facing(rope) *
                        AngleAxisd(dice.uniform(-kPi, kPi), Vector3d::UnitZ());
  orient(rope, turn, view);
  if (!stand_back(rope, {.distance_m = {0.3, 0.5}}, dice, view)) return std::nullopt;
  add_table(rope, view);
  return view;
}

std::optional<View> try_wide_view(const Rope& rope, Dice& dice) {
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
  orient(rope, turn, view);
  Wish wish{.distance_m = {std::max(0.25, view.sensor->nearest_m), 1.5},
            .looseness = dice.uniform(1.1, 2.0)};
  if (dice.chance(0.08)) wish = {wish.distance_m, 1.02, dice.uniform(0.8, 0.95)};
  if (!stand_back(rope, wish, dice, view)) return std::nullopt;
  if (rope.hanging) {
    add_wall(dice, view);
  } else {
    add_table(rope, view);
  }
  if (!ground_is_behind(rope, view)) return std::nullopt;
  return view;
}

}  // namespace flowdlo::synth
