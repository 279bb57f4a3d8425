#include "synth/hanging_rope.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace flowdlo::synth {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

double eased(double t) {
  const double c = std::clamp(t, 0.0, 1.0);
  return c * c * c * (c * (6 * c - 15) + 10);
}

struct Loop {
  double from = 0;   // share of the length
  double share = 0;  // of the length
  double sign = 1;
  double offset = 0;  // metres out of the plane between the strands that cross
};

// A turn of 2 pi is steepest by 1.875 in the middle.
std::vector<Loop> loops_of(const Gauge& gauge, int count, Dice& dice) {
  std::vector<Loop> loops;
  const double least = 1.875 * kTurn * gauge.least_bend_m / gauge.length_m;
  double from = dice.uniform(0.12, 0.3);
  const double room = (0.88 - from) / std::max(1, count);
  for (int k = 0; k < count; ++k) {
    Loop loop;
    loop.share = std::min(std::max(1.25 * least, dice.uniform(0.2, 0.45)), room);
    loop.from = from + dice.uniform(0, room - loop.share);
    loop.sign = dice.sign();
    loop.offset = dice.sign() * gauge.radius_m *
                  (dice.chance(0.5) ? dice.uniform(2.3, 4.0) : dice.uniform(4.0, 20.0));
    loops.push_back(loop);
    from += room;
  }
  return loops;
}

// Heading of a catenary, tan = (s - bottom) / stiffness; of one end: straight down with a curl.
double heading_of(double t, bool two, double bottom, double flatness, double curl) {
  if (two) return std::atan((t - bottom) / flatness);
  return -0.5 * std::numbers::pi + curl * t * t;
}

}  // namespace

Curve hung(const Gauge& gauge, const Hanging& hanging, Dice& dice) {
  const auto count =
      static_cast<std::size_t>(std::max(256.0, std::ceil(gauge.length_m / (0.5 * gauge.radius_m))));
  const double step = gauge.length_m / static_cast<double>(count);
  const double bottom = dice.uniform(0.3, 0.7);
  const double least_flatness = gauge.least_bend_m / gauge.length_m;
  const double flatness = std::max(least_flatness, dice.log_uniform(0.08, 0.8));
  const double mirror = dice.sign();
  const double curl = dice.uniform(-1.0, 1.0) * std::min(2.2, 0.4 / least_flatness);
  const double waves = dice.uniform(0, 0.25);
  const double wave_frequency = dice.uniform(1.0, 2.5);
  const double wave_phase = dice.uniform(0, kTurn);
  const auto loops = loops_of(gauge, hanging.loops, dice);
  const double swing_phase = dice.uniform(0, kTurn);
  const double swing_frequency = dice.uniform(0.5, 1.6);
  const double slope = dice.uniform(-0.5, 0.5) * hanging.swing_m;
  const auto out_of_plane = [&](double t) {
    double out =
        slope * t + 0.5 * hanging.swing_m * std::sin(kTurn * swing_frequency * t + swing_phase);
    for (const Loop& loop : loops) out += 1.4 * loop.offset * eased((t - loop.from) / loop.share);
    return out;
  };
  std::vector<Vector3d> points{Vector3d(0, 0, out_of_plane(0))};
  points.reserve(count + 1);
  Vector2d at = Vector2d::Zero();
  for (std::size_t i = 0; i < count; ++i) {
    const double t = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    double angle = heading_of(t, hanging.two_grippers, bottom, flatness, curl);
    angle += waves * std::sin(kTurn * wave_frequency * t + wave_phase);
    for (const Loop& loop : loops) {
      angle += loop.sign * kTurn * eased((t - loop.from) / loop.share);
    }
    at += step * Vector2d(mirror * std::cos(angle), -std::sin(angle));
    points.emplace_back(at.x(), at.y(),
                        out_of_plane(static_cast<double>(i + 1) / static_cast<double>(count)));
  }
  return respaced(points, 0.5 * gauge.radius_m);
}

}  // namespace flowdlo::synth
