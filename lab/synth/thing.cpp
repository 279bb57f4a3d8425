#include "synth/thing.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace flowdlo::synth {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
constexpr double kPi = std::numbers::pi;

double distance_to(const Capsule& capsule, const Vector3d& p) {
  const Vector3d d = capsule.to - capsule.from;
  const double t = std::clamp((p - capsule.from).dot(d) / d.squaredNorm(), 0.0, 1.0);
  return (p - capsule.from - t * d).norm();
}

// True when the capsule, fatter by `margin_m`, holds no part of a rope.
bool clear_of_ropes(const Capsule& capsule, const View& view, double margin_m) {
  for (const Curve& curve : view.curves) {
    for (std::size_t i = 0; i < curve.points.size(); i += 2) {
      if (distance_to(capsule, curve.points[i]) < capsule.radius_m + margin_m) return false;
    }
  }
  return true;
}

const Vector3d& inner_point(const View& view, double margin, Dice& dice) {
  const auto& points = view.curves[dice.any_of(view.curves.size())].points;
  const auto count = static_cast<double>(points.size() - 1);
  return points[static_cast<std::size_t>(dice.uniform(margin, 1 - margin) * count)];
}

// A frame whose first column is `along`.
Matrix3d frame_along(const Vector3d& along, double roll) {
  Matrix3d axes;
  axes.col(0) = along.normalized();
  const Vector3d other = std::abs(axes(2, 0)) < 0.8 ? Vector3d::UnitZ() : Vector3d::UnitX();
  axes.col(1) = other.cross(axes.col(0)).normalized();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return axes * AngleAxisd(roll, Vector3d::UnitX()).matrix();
}

Vector3d dull_color(Dice& dice) {
  const double grey = dice.uniform(40, 220);
  return {grey * dice.uniform(0.75, 1.05), grey * dice.uniform(0.8, 1.0),
          grey * dice.uniform(0.8, 1.1)};
}

// The point of the ground, or of a depth behind the rope, that a random pixel sees.
std::optional<Vector3d> random_place(const View& view, bool on_ground, Dice& dice) {
  const Vector3d ray((dice.uniform(0, view.sensor->width) - view.camera.cx) / view.camera.fx,
                     (dice.uniform(0, view.sensor->height) - view.camera.cy) / view.camera.fy, 1);
  const double slope = view.ground.normal.dot(ray);
  const double ground = slope < -1e-6 ? view.ground.offset_m / slope : 5.0;
  if (on_ground) return ground < 3.0 ? std::optional<Vector3d>(ground * ray) : std::nullopt;
  double farthest = 0;
  for (const Curve& curve : view.curves) {
    for (const Vector3d& p : curve.points) farthest = std::max(farthest, p.z());
  }
  const double low = farthest + 0.12;
  const double high = std::min(ground - 0.05, farthest + 1.5);
  if (low >= high) return std::nullopt;
  return dice.uniform(low, high) * ray;
}

Thing box_at(const Vector3d& place, const Vector3d& up, Dice& dice) {
  Thing thing;
  const Vector3d half(dice.log_uniform(0.008, 0.06), dice.log_uniform(0.008, 0.06),
                      dice.log_uniform(0.003, 0.04));
  Matrix3d axes = frame_along(up, dice.uniform(-kPi, kPi));
  axes = (Matrix3d() << axes.col(1), axes.col(2), axes.col(0)).finished();
  thing.boxes.push_back({place + up * half.z(), axes, half});
  return thing;
}

Thing rod_at(const Vector3d& place, const Vector3d& up, Dice& dice) {
  Thing thing;
  const double radius = dice.log_uniform(0.002, 0.02);
  const Vector3d along = frame_along(up, dice.uniform(-kPi, kPi)).col(1);
  const double half = dice.uniform(0.03, 0.15);
  const Vector3d middle = place + up * radius;
  thing.capsules.push_back({middle - half * along, middle + half * along, radius});
  return thing;
}

// Another cable, an arc of a few rods.
Thing cable_at(const Vector3d& place, const Vector3d& up, Dice& dice) {
  Thing thing;
  const double radius = dice.log_uniform(0.0015, 0.006);
  const double bend = dice.uniform(-0.35, 0.35);
  const Matrix3d plane = frame_along(up, dice.uniform(-kPi, kPi));
  Vector3d at = place + up * radius;
  double heading = 0;
  for (int k = 0; k < 12; ++k) {
    const Vector3d next =
        at + 0.02 * (std::cos(heading) * plane.col(1) + std::sin(heading) * plane.col(2));
    thing.capsules.push_back({at, next, radius});
    at = next;
    heading += bend + dice.uniform(-0.15, 0.15);
  }
  return thing;
}

bool keeps_off(const Thing& thing, const View& view, double radius_m) {
  const double margin = radius_m + 0.004;
  return std::all_of(thing.capsules.begin(), thing.capsules.end(),
                     [&](const Capsule& c) { return clear_of_ropes(c, view, margin); }) &&
         std::all_of(thing.boxes.begin(), thing.boxes.end(), [&](const Box& box) {
           const Capsule around{box.middle, box.middle + 1e-6 * box.axes.col(0), box.half_m.norm()};
           return clear_of_ropes(around, view, margin);
         });
}

}  // namespace

void add_bars(const View& view, double radius_m, Dice& dice, std::vector<Thing>& things) {
  const int wanted = dice.chance(0.65) ? 1 : 2;
  int made = 0;
  for (int tries = 0; tries < 12 && made < wanted; ++tries) {
    const Vector3d p = inner_point(view, 0.1, dice);
    const double share = dice.uniform(0.6, 0.95);
    const Vector3d middle = share * p;
    const double angle = dice.uniform(0, kPi);
    const Vector3d along =
        Vector3d(std::cos(angle), std::sin(angle), dice.uniform(-0.15, 0.15)).normalized();
    const double half_width =
        std::clamp(radius_m * share * dice.log_uniform(1.2, 7.0), 0.002, 0.04);
    const double reach = 1.6 * middle.z();
    const bool ends_here = dice.chance(0.3);  // a tool rather than a bar across the image
    const Vector3d from = middle - (ends_here ? 3 * half_width : reach) * along;
    const Vector3d to = middle + reach * along;
    const Capsule body{from, to, half_width};
    if (!clear_of_ropes(body, view, 2 * radius_m) || std::min(from.z(), to.z()) < 0.06) continue;
    Thing bar{.kind = ThingKind::kBar, .capsules = {}, .boxes = {}, .color_bgr = dull_color(dice)};
    if (dice.chance(0.5)) {
      bar.capsules.push_back(body);
    } else {
      bar.boxes.push_back({0.5 * (from + to),
                           frame_along(along, dice.uniform(-0.5, 0.5)),
                           {0.5 * (to - from).norm(), half_width, half_width}});
    }
    things.push_back(std::move(bar));
    ++made;
  }
}

void add_hand(const View& view, double radius_m, Dice& dice, std::vector<Thing>& things) {
  const Vector3d p = inner_point(view, 0.03, dice);
  const double angle = dice.uniform(0, 2 * kPi);
  const Vector3d toward = -p.normalized();
  const Vector3d reach_raw(std::cos(angle), std::sin(angle), 0);
  const Vector3d reach = (reach_raw - toward * toward.dot(reach_raw)).normalized();
  const Vector3d across = toward.cross(reach);
  const double size = dice.uniform(0.8, 1.1);
  const double finger = 0.0085 * size;
  const Vector3d over = (radius_m + 1.1 * finger) * toward;
  const Vector3d palm = p + size * (0.085 * reach + 0.045 * toward);
  Thing hand{.kind = ThingKind::kHand, .capsules = {}, .boxes = {}, .color_bgr = {}};
  const double tone = dice.uniform(0.35, 1.0);
  hand.color_bgr = tone * Vector3d(150, 175, 225);
  const int fingers = dice.integer(1, 4);
  for (int k = 0; k < 4; ++k) {
    const double side = size * (k - 1.5);
    const Vector3d base = palm + 0.019 * side * across;
    const bool pinches = k < fingers;  // the others are folded into the palm
    const Vector3d knuckle =
        pinches ? Vector3d(p + 0.035 * size * reach + 0.016 * side * across + 0.035 * size * toward)
                : Vector3d(base - 0.03 * size * reach + 0.01 * toward);
    const Vector3d tip = pinches ? Vector3d(p - 0.004 * reach + 0.014 * side * across + over)
                                 : Vector3d(base - 0.02 * size * reach - 0.012 * toward);
    hand.capsules.push_back({base, knuckle, 1.1 * finger});
    hand.capsules.push_back({knuckle, tip, finger});
  }
  hand.capsules.push_back({palm - 0.03 * size * across + 0.01 * reach,
                           p + 0.012 * reach - 0.03 * size * across + over, 1.15 * finger});
  hand.capsules.push_back(
      {palm - 0.022 * size * across, palm + 0.045 * size * reach, 0.021 * size});
  hand.capsules.push_back(
      {palm + 0.022 * size * across, palm + 0.045 * size * reach, 0.021 * size});
  const Vector3d wrist = palm + 0.07 * size * reach;
  const Vector3d elbow = wrist + std::max(0.5, 0.9 * p.z()) * (reach + 0.25 * toward);
  hand.capsules.push_back({wrist, elbow, 0.028 * size});
  if (elbow.z() < 0.05) return;  // the arm would run into the camera
  things.push_back(std::move(hand));
}

void add_grippers(const View& view, const Rope& rope, const Curve& curve, Dice& dice,
                  std::vector<Thing>& things) {
  const auto& points = curve.points;
  const double r = rope.radius_m;
  const Vector3d color = dull_color(dice);
  for (int k = 0; k < rope.grippers; ++k) {
    const Vector3d end = k == 0 ? points.front() : points.back();
    const Vector3d inner = k == 0 ? points[4] : points[points.size() - 5];
    const Vector3d out = (end - inner).normalized();
    const double cover = dice.chance(0.4) ? dice.uniform(0.3, 1.0) * 0.02 : 0.0;
    const double half = 0.018;
    const Vector3d middle = end + (half - cover) * out;
    Thing gripper{.kind = ThingKind::kGripper, .capsules = {}, .boxes = {}, .color_bgr = color};
    gripper.boxes.push_back(
        {middle, frame_along(out, dice.uniform(-kPi, kPi)), {half, 0.008 + r, 0.008 + r}});
    const Vector3d up = view.turn * Vector3d(0, -1, 0);
    const Vector3d arm = (out + dice.uniform(0.3, 1.2) * up).normalized();
    gripper.capsules.push_back({middle + 0.02 * out, middle + 0.02 * out + 0.6 * arm, 0.018});
    if (gripper.capsules.front().to.z() > 0.08 &&
        clear_of_ropes(gripper.capsules.front(), view, r)) {
      things.push_back(std::move(gripper));
    }
  }
}

void add_clutter(const View& view, double radius_m, bool hanging, Dice& dice,
                 std::vector<Thing>& things) {
  const int wanted = dice.integer(2, 7);
  for (int k = 0; k < wanted; ++k) {
    const auto place = random_place(view, !hanging, dice);
    if (!place) continue;
    const Vector3d up = hanging ? Vector3d(view.turn * Vector3d(0, -1, 0)) : view.ground.normal;
    const std::size_t what = dice.pick({0.5, 0.25, 0.25});
    Thing thing = what == 0   ? box_at(*place, up, dice)
                  : what == 1 ? rod_at(*place, up, dice)
                              : cable_at(*place, up, dice);
    thing.color_bgr = dice.chance(0.6) ? dull_color(dice)
                                       : Vector3d(dice.uniform(20, 230), dice.uniform(20, 230),
                                                  dice.uniform(20, 230));
    if (keeps_off(thing, view, radius_m)) things.push_back(std::move(thing));
  }
}

}  // namespace flowdlo::synth
