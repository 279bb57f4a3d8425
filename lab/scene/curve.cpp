#include "scene/curve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace flowdlo::lab {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
constexpr double kTurn = 2 * std::numbers::pi;
constexpr int kAttempts = 600;
constexpr double kClear = 2.8;      // radii between strands that do not cross
constexpr double kFlattest = 0.42;  // sine of the flattest crossing
constexpr double kClearEnd = 5.0;   // radii of rope beyond its last crossing
constexpr double kTightest = 5.0;   // radii of the tightest bend

void centre(Curve2& curve) {
  Vector2d low = curve.front();
  Vector2d high = curve.front();
  for (const Vector2d& p : curve) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Vector2d middle = 0.5 * (low + high);
  for (Vector2d& p : curve) p -= middle;
}

double spacing(const Curve2& curve) { return curve.size() < 2 ? 0 : (curve[1] - curve[0]).norm(); }

// Integrates a heading made of a few sines.
Curve2 attempt(const Shape& shape, Random& random) {
  const double step = 0.5 * shape.radius_m;
  const int count = std::max(16, static_cast<int>(shape.length_m / step));
  const int waves = random.integer(2, 4);
  std::vector<Vector3d> terms;  // amplitude, frequency, phase
  for (int k = 0; k < waves; ++k) {
    terms.emplace_back(random.uniform(0.3, 1.0) * shape.wander * kTurn / (1.0 + k),
                       random.uniform(0.4, 1.0) * (k + 1), random.uniform(0, kTurn));
  }
  const double turn = random.uniform(-1, 1) * shape.wander * kTurn;
  const double start = random.uniform(0, kTurn);
  Curve2 curve{Vector2d::Zero()};
  for (int i = 1; i < count; ++i) {
    const double t = static_cast<double>(i) / count;
    double heading = start + turn * t;
    for (const Vector3d& term : terms) {
      heading += term.x() * std::sin(kTurn * term.y() * t + term.z());
    }
    curve.push_back(curve.back() + step * Vector2d(std::cos(heading), std::sin(heading)));
  }
  centre(curve);
  return curve;
}

double tightest(const Curve2& curve) {
  double radius = std::numeric_limits<double>::max();
  const double step = spacing(curve);
  for (std::size_t i = 2; i < curve.size(); ++i) {
    const Vector2d a = curve[i - 1] - curve[i - 2];
    const Vector2d b = curve[i] - curve[i - 1];
    const double turn = std::abs(std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b)));
    if (turn > 1e-9) radius = std::min(radius, step / turn);
  }
  return radius;
}

// True when strands come near each other at crossings only.
bool clear(const Curve2& curve, const std::vector<Crossing>& all, double radius) {
  const double step = spacing(curve);
  const int stride = 2;
  const int apart = static_cast<int>(4 * kClear * radius / step);
  for (int i = 0; i < static_cast<int>(curve.size()); i += stride) {
    for (int j = i + apart; j < static_cast<int>(curve.size()); j += stride) {
      if ((curve[i] - curve[j]).squaredNorm() > kClear * kClear * radius * radius) continue;
      const bool known = std::any_of(all.begin(), all.end(), [&](const Crossing& c) {
        const double zone = kClear * radius * (1.5 / c.sine + 1.5);
        return std::abs(i * step - c.first_m) < zone && std::abs(j * step - c.second_m) < zone;
      });
      if (!known) return false;
    }
  }
  return true;
}

double bump(double distance, double half_length) {
  const double t = std::abs(distance) / half_length;
  return t >= 1 ? 0 : 0.5 * (1 + std::cos(std::numbers::pi * t));
}

}  // namespace

std::vector<Crossing> crossings(const Curve2& curve) {
  std::vector<Crossing> result;
  const double step = spacing(curve);
  const int stride = 4;
  const auto side = [](const Vector2d& a, const Vector2d& b) {
    return a.x() * b.y() - a.y() * b.x();
  };
  const int count = static_cast<int>(curve.size());
  for (int i = 0; i + stride < count; i += stride) {
    const Vector2d p = curve[i];
    const Vector2d d = curve[i + stride] - p;
    for (int j = i + 2 * stride; j + stride < count; j += stride) {
      const Vector2d e = curve[j + stride] - curve[j];
      const double cross = side(d, e);
      if (std::abs(cross) < 1e-15) continue;
      const Vector2d between = curve[j] - p;
      const double t = side(between, e) / cross;
      const double s = side(between, d) / cross;
      if (t < 0 || t >= 1 || s < 0 || s >= 1) continue;
      result.push_back({(i + t * stride) * step, (j + s * stride) * step,
                        std::abs(cross) / (d.norm() * e.norm())});
    }
  }
  return result;
}

std::optional<Curve2> wandering(const Shape& shape, Random& random) {
  for (int k = 0; k < kAttempts; ++k) {
    Curve2 curve = attempt(shape, random);
    if (tightest(curve) < kTightest * shape.radius_m) continue;
    const auto all = crossings(curve);
    const auto count = static_cast<int>(all.size());
    if (count < shape.least_crossings || count > shape.most_crossings) continue;
    const bool steep =
        std::all_of(all.begin(), all.end(), [](const Crossing& c) { return c.sine > kFlattest; });
    const double end = kClearEnd * shape.radius_m;
    const double whole = spacing(curve) * static_cast<double>(curve.size() - 1);
    const bool inner = std::all_of(all.begin(), all.end(), [&](const Crossing& c) {
      return c.first_m > end && c.second_m < whole - end;
    });
    if (steep && inner && clear(curve, all, shape.radius_m)) return curve;
  }
  return std::nullopt;
}

Curve2 hairpin(const Shape& shape, Random& random) {
  const double r = shape.radius_m;
  const double gap = random.uniform(1.98, 2.15) * r;  // between the centerlines where they touch
  const double bulb = random.uniform(2.5, 6.0) * r;   // half width of the turn
  const double half = 0.5 * shape.length_m;
  const double open = random.uniform(0.15, 0.4) * half;
  const double bend = random.uniform(-1.5, 1.5) / half;
  const double spread = random.uniform(0.3, 0.9);
  Curve2 side;  // the right strand, from the open end to the turn's tip, along a straight axis
  const double neck = half - 6 * bulb;
  const double step = 0.25 * r;
  for (double y = 0; y < neck; y += step) {
    const double opening = y < open ? spread * (open - y) * (open - y) / open : 0;
    side.emplace_back(0.5 * gap + opening, y);
  }
  for (double t = 0; t < 1; t += 0.004) {  // neck to bulb: out by a cosine, then a half circle
    side.emplace_back(0.5 * gap + (bulb - 0.5 * gap) * 0.5 * (1 - std::cos(std::numbers::pi * t)),
                      neck + 4 * bulb * t);
  }
  for (double t = 0; t <= 0.5 * std::numbers::pi; t += 0.02) {
    side.emplace_back(bulb * std::cos(t), neck + 4 * bulb + bulb * std::sin(t));
  }
  Curve2 whole = side;
  for (auto it = side.rbegin(); it != side.rend(); ++it) whole.emplace_back(-it->x(), it->y());
  for (Vector2d& p : whole) {  // bend the axis to an arc
    const double angle = bend * p.y();
    const double axis_x = std::abs(bend) < 1e-9 ? 0 : (1 - std::cos(angle)) / bend;
    const double axis_y = std::abs(bend) < 1e-9 ? p.y() : std::sin(angle) / bend;
    p = Vector2d(axis_x + p.x() * std::cos(angle), axis_y - p.x() * std::sin(angle));
  }
  const double turn = random.uniform(0, kTurn);
  for (Vector2d& p : whole) {
    p = Vector2d(p.x() * std::cos(turn) - p.y() * std::sin(turn),
                 p.x() * std::sin(turn) + p.y() * std::cos(turn));
  }
  centre(whole);
  return whole;
}

Curve2 coil(const Shape& shape, Random& random) {
  const double r = shape.radius_m;
  const double pitch = random.uniform(2.02, 3.2) * r;
  const double inner = random.uniform(6, 10) * r;
  const double turns = random.uniform(2, 3);
  const double start = random.uniform(0, kTurn);
  const double sign = random.chance(0.5) ? 1 : -1;
  Curve2 curve;
  for (double angle = 0; angle < turns * kTurn; angle += 0.02) {
    const double radius = inner + pitch * angle / kTurn;
    curve.emplace_back(radius * std::cos(start + sign * angle),
                       radius * std::sin(start + sign * angle));
  }
  const Vector2d out = (curve.back() - curve[curve.size() - 2]).normalized();
  const double tail = random.uniform(0.02, 0.15);
  for (double s = 0.5 * r; s < tail; s += 0.5 * r) curve.push_back(curve.back() + 0.5 * r * out);
  centre(curve);
  return curve;
}

Curve3 laid(const Curve2& flat, double radius_m, Random& random) {
  const auto all = crossings(flat);
  const double step = spacing(flat);
  Curve3 curve;
  for (const Vector2d& p : flat) curve.emplace_back(p.x(), p.y(), 0);
  for (const Crossing& c : all) {
    const double over = random.chance(0.5) ? c.first_m : c.second_m;
    const double half = radius_m * (3 / c.sine + 7);
    for (std::size_t i = 0; i < curve.size(); ++i) {
      const double lift = 2.1 * radius_m * bump(static_cast<double>(i) * step - over, half);
      curve[i].z() = std::min(curve[i].z(), -lift);
    }
  }
  return curve;
}

Curve3 floated(const Curve2& flat, double swing_m, Random& random) {
  const double slope = random.uniform(-1, 1);
  const double frequency = random.uniform(0.3, 1.2);
  const double phase = random.uniform(0, kTurn);
  Curve3 curve;
  for (std::size_t i = 0; i < flat.size(); ++i) {
    const double t = static_cast<double>(i) / static_cast<double>(flat.size());
    const double z = swing_m * (slope * (t - 0.5) + 0.5 * std::sin(kTurn * frequency * t + phase));
    curve.emplace_back(flat[i].x(), flat[i].y(), z);
  }
  return curve;
}

double separation(const Curve3& curve, double radius_m) {
  double least = std::numeric_limits<double>::max();
  if (curve.size() < 2) return least;
  const double step = (curve[1] - curve[0]).norm();
  const int apart = static_cast<int>(8 * radius_m / std::max(step, 1e-9));
  for (int i = 0; i < static_cast<int>(curve.size()); ++i) {
    for (int j = i + apart; j < static_cast<int>(curve.size()); ++j) {
      least = std::min(least, (curve[i] - curve[j]).squaredNorm());
    }
  }
  return std::sqrt(least);
}

Curve3 respaced(const Curve3& curve, double spacing_m) {
  std::vector<double> along{0};
  for (std::size_t i = 1; i < curve.size(); ++i) {
    along.push_back(along.back() + (curve[i] - curve[i - 1]).norm());
  }
  const int count = std::max(2, static_cast<int>(std::lround(along.back() / spacing_m)) + 1);
  Curve3 result;
  std::size_t at = 1;
  for (int k = 0; k < count; ++k) {
    const double s = along.back() * k / (count - 1);
    while (at + 1 < curve.size() && along[at] < s) ++at;
    const double length = along[at] - along[at - 1];
    const double t = length > 0 ? std::clamp((s - along[at - 1]) / length, 0.0, 1.0) : 0;
    result.push_back(curve[at - 1] + t * (curve[at] - curve[at - 1]));
  }
  return result;
}

}  // namespace flowdlo::lab
