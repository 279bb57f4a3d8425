#include "synth/flat_shape.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace flowdlo::synth {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr int kAttempts = 120;
constexpr double kFlattest = 0.32;    // sine of the flattest crossing
constexpr double kClear = 2.7;        // radii between strands that neither cross nor touch
constexpr double kClearEnd = 4.0;     // radii of rope beyond its last crossing
constexpr std::size_t kCoarse = 320;  // samples of an attempt

struct Wave {
  double amplitude;
  double frequency;
  double phase;
};

std::vector<Wave> slow_waves(const Heading& heading, Dice& dice) {
  std::vector<Wave> waves;
  if (heading.swing > 0) {
    waves.push_back({heading.swing, dice.uniform(0.85, 1.15), dice.uniform(-0.4, 0.4)});
  }
  const int slow = heading.wander > 0 ? dice.integer(2, 4) : 0;
  for (int k = 0; k < slow; ++k) {
    waves.push_back({dice.uniform(0.3, 1.0) * heading.wander / (1.0 + k),
                     dice.uniform(0.4, 1.0) * (k + 1), dice.uniform(0, kTurn)});
  }
  return waves;
}

std::vector<Wave> fast_waves(const Heading& heading, Dice& dice) {
  std::vector<Wave> waves;
  const int fast = heading.wiggle > 0 ? dice.integer(1, 2) : 0;
  for (int k = 0; k < fast; ++k) {
    waves.push_back(
        {dice.uniform(0.5, 1.0) * heading.wiggle, dice.uniform(3.0, 6.0), dice.uniform(0, kTurn)});
  }
  return waves;
}

double steepest_slope(double turn, const std::vector<Wave>& waves) {
  double steepest = 1e-9;
  for (std::size_t i = 0; i < kCoarse; ++i) {
    const double t = static_cast<double>(i) / kCoarse;
    double slope = turn;
    for (const Wave& w : waves) {
      slope += w.amplitude * kTurn * w.frequency * std::cos(kTurn * w.frequency * t + w.phase);
    }
    steepest = std::max(steepest, std::abs(slope));
  }
  return steepest;
}

// A rope's heading along it, nowhere steeper than its tightest bend allows.
struct Course {
  double start = 0;
  double turn = 0;
  std::vector<Wave> waves;
};

// Where all of it would bend the rope too much, the fast waves give way first.
Course course_of(const Gauge& gauge, const Heading& heading, Dice& dice) {
  Course course;
  course.turn = heading.turn * dice.uniform(0.7, 1.0) * dice.sign();
  course.start = dice.uniform(0, kTurn);
  auto slow = slow_waves(heading, dice);
  auto fast = fast_waves(heading, dice);
  const double most = gauge.length_m / gauge.least_bend_m;
  const double share = std::min(1.0, most / steepest_slope(course.turn, slow));
  course.turn *= share;
  for (Wave& wave : slow) wave.amplitude *= share;
  const double left = most - steepest_slope(course.turn, slow);
  const double fine = std::clamp(left / steepest_slope(0, fast), 0.0, 1.0);
  for (Wave& wave : fast) wave.amplitude *= fine;
  course.waves = std::move(slow);
  course.waves.insert(course.waves.end(), fast.begin(), fast.end());
  return course;
}

// A turn about once around, its bend growing from nothing and shrinking again.
struct Loop {
  double middle = 0;  // share of the rope
  double half = 0;    // likewise
  double angle = 0;   // radians, of either sign

  [[nodiscard]] double turned_by(double t) const {
    const double s = std::clamp((t - middle) / half, -1.0, 1.0);
    return 0.5 * angle * (1 + s + std::sin(std::numbers::pi * s) / std::numbers::pi);
  }
};

// The bend is twice as strong in the middle of a loop as in its mean.
Loop draw_loop(const Gauge& gauge, int number, int loops, Dice& dice) {
  const double angle = kTurn * dice.uniform(0.75, 1.1);
  const double longest = 0.9 * gauge.length_m / loops;
  const double shortest = 2 * angle * gauge.least_bend_m;
  const double length = std::min(longest, shortest * dice.log_uniform(1.0, 3.0));
  const double free = std::max(0.0, 1.0 / loops - length / gauge.length_m);
  return {(number + 0.5) / loops + 0.5 * free * dice.uniform(-1, 1), 0.5 * length / gauge.length_m,
          angle * dice.sign()};
}

Course gentle_course(const Gauge& gauge, Dice& dice) {
  return course_of(gauge, {.turn = dice.uniform(0, 2), .wander = dice.uniform(0.1, 0.9)}, dice);
}

FlatPoints integrate(const Gauge& gauge, const Course& course, std::size_t count,
                     const std::vector<Loop>& loops = {}) {
  const double step = gauge.length_m / static_cast<double>(count);
  FlatPoints points{Vector2d::Zero()};
  points.reserve(count + 1);
  for (std::size_t i = 0; i < count; ++i) {
    const double t = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    double angle = course.start + course.turn * t;
    for (const Wave& w : course.waves) {
      angle += w.amplitude * std::sin(kTurn * w.frequency * t + w.phase);
    }
    for (const Loop& loop : loops) angle += loop.turned_by(t);
    points.emplace_back(points.back() + step * Vector2d(std::cos(angle), std::sin(angle)));
  }
  return points;
}

bool fits(const std::vector<Crossing>& all, const Heading& heading, const Gauge& gauge,
          double step_m, std::size_t count) {
  const auto found = static_cast<int>(all.size());
  if (found < heading.least_crossings || found > heading.most_crossings) return false;
  const double end = kClearEnd * gauge.radius_m / step_m;
  return std::all_of(all.begin(), all.end(), [&](const Crossing& c) {
    return c.sine > kFlattest && c.first > end && c.second < static_cast<double>(count) - end;
  });
}

// True when strands come near each other at crossings only.
bool clear(const FlatPoints& points, const std::vector<Crossing>& all, const Gauge& gauge,
           double step_m) {
  const double near = kClear * gauge.radius_m;
  const auto apart = static_cast<std::size_t>(std::ceil(1.7 * near / step_m)) + 1;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + apart; j < points.size(); ++j) {
      const double distance = (points[i] - points[j]).norm();
      if (distance > near) {  // no nearer for as many samples as the distance takes
        j += static_cast<std::size_t>((distance - near) / step_m);
        continue;
      }
      const bool known = std::any_of(all.begin(), all.end(), [&](const Crossing& c) {
        const double zone = 1.5 * near * (1 / c.sine + 1) / step_m;
        return std::abs(static_cast<double>(i) - c.first) < zone &&
               std::abs(static_cast<double>(j) - c.second) < zone;
      });
      if (!known) return false;
    }
  }
  return true;
}

std::size_t fine_count(const Gauge& gauge) {
  return static_cast<std::size_t>(std::ceil(gauge.length_m / (0.5 * gauge.radius_m)));
}

// Bends what was made along the y axis to an arc, whose outer side is no tighter than allowed.
void bend_axis(FlatPoints& points, const Gauge& gauge, Dice& dice) {
  double widest = 0;
  double longest = 0;
  for (const Vector2d& p : points) {
    widest = std::max(widest, std::abs(p.x()));
    longest = std::max(longest, p.y());
  }
  const double limit = 1 / (2 * widest + 3 * gauge.least_bend_m);
  const double bend = dice.uniform(-1, 1) * std::min(limit, 3.0 / longest);
  if (std::abs(bend) < 1e-6) return;
  for (Vector2d& p : points) {
    const double angle = bend * p.y();
    const Vector2d axis((1 - std::cos(angle)) / bend, std::sin(angle) / bend);
    p = axis + p.x() * Vector2d(std::cos(angle), -std::sin(angle));
  }
}

}  // namespace

std::optional<FlatPoints> wandering(const Gauge& gauge, const Heading& heading, Dice& dice) {
  for (int k = 0; k < kAttempts; ++k) {
    const Course course = course_of(gauge, heading, dice);
    const FlatPoints coarse = integrate(gauge, course, kCoarse);
    const double step = gauge.length_m / kCoarse;
    const auto all = crossings(coarse);
    if (!fits(all, heading, gauge, step, kCoarse)) continue;
    if (!clear(coarse, all, gauge, step)) continue;
    return integrate(gauge, course, std::max(kCoarse, fine_count(gauge)));
  }
  return std::nullopt;
}

std::optional<FlatPoints> looped(const Gauge& gauge, int loops, Dice& dice) {
  for (int k = 0; k < kAttempts; ++k) {
    const Course course = gentle_course(gauge, dice);
    std::vector<Loop> all_loops;
    for (int i = 0; i < loops; ++i) all_loops.push_back(draw_loop(gauge, i, loops, dice));
    const auto count = std::max(kCoarse, fine_count(gauge));
    const FlatPoints points = integrate(gauge, course, count, all_loops);
    const double step = gauge.length_m / static_cast<double>(count);
    const auto all = crossings(points);
    const Heading heading{.least_crossings = loops, .most_crossings = 3 * loops};
    if (fits(all, heading, gauge, step, count) && clear(points, all, gauge, step)) return points;
  }
  return std::nullopt;
}

FlatPoints doubled(const Gauge& gauge, bool roomy, Dice& dice) {
  const double r = gauge.radius_m;
  const double half_gap = 0.5 * r * dice.uniform(2.0, 2.15);
  const double bulb =
      gauge.least_bend_m * (roomy ? dice.uniform(1.5, 3.0) : dice.uniform(1.0, 1.4));
  const double half = 0.5 * gauge.length_m;
  const double neck_length = std::max(3.2 * bulb, 4 * r);
  const double neck = std::max(0.3 * half, half - neck_length - 1.6 * bulb);
  const double open = roomy ? dice.uniform(0.25, 0.6) * neck : dice.uniform(0.05, 0.3) * neck;
  const double spread = std::min(dice.uniform(0.3, 0.9), 0.25 * open / gauge.least_bend_m);
  FlatPoints side;  // the right strand from the open end to the tip of the turn
  for (double y = 0; y < neck; y += 0.25 * r) {
    const double left = std::max(0.0, open - y);
    side.emplace_back(half_gap + spread * left * left / open, y);
  }
  for (double t = 0; t < 1; t += 0.005) {
    side.emplace_back(half_gap + (bulb - half_gap) * 0.5 * (1 - std::cos(std::numbers::pi * t)),
                      neck + neck_length * t);
  }
  for (double t = 0; t < 0.5 * std::numbers::pi; t += 0.02) {
    side.emplace_back(bulb * std::cos(t), neck + neck_length + bulb * std::sin(t));
  }
  FlatPoints whole = side;
  for (auto it = side.rbegin(); it != side.rend(); ++it) whole.emplace_back(-it->x(), it->y());
  bend_axis(whole, gauge, dice);
  const double shorter = dice.chance(0.6) ? dice.uniform(0, 0.25) : 0.0;  // one end is ahead
  whole.resize(whole.size() - static_cast<std::size_t>(shorter * static_cast<double>(side.size())));
  return whole;
}

FlatPoints coil(const Gauge& gauge, Dice& dice) {
  const double r = gauge.radius_m;
  const double pitch = r * (dice.chance(0.5) ? dice.uniform(2.02, 2.2) : dice.uniform(2.2, 3.2));
  const double turns = dice.uniform(2.0, 3.0);
  const double tail = dice.uniform(0.05, 0.3) * gauge.length_m;
  const double mean = (gauge.length_m - tail) / (turns * kTurn);
  const double inner = std::max(1.1 * gauge.least_bend_m, mean - 0.5 * pitch * turns);
  const double start = dice.uniform(0, kTurn);
  const double sign = dice.sign();
  FlatPoints points;
  for (double angle = 0; angle < turns * kTurn; angle += 0.25 * r / inner) {
    const double radius = inner + pitch * angle / kTurn;
    points.emplace_back(radius * std::cos(start + sign * angle),
                        radius * std::sin(start + sign * angle));
  }
  // The tail straightens evenly: its heading is a parabola in arclength.
  const Vector2d out = points.back() - points[points.size() - 2];
  const double heading = std::atan2(out.y(), out.x());
  const double outer = inner + pitch * turns;
  const double step = 0.25 * r;
  for (double s = step; s < tail; s += step) {
    const double angle = heading + sign * (s - 0.5 * s * s / tail) / outer * 0.6;
    points.emplace_back(points.back() + step * Vector2d(std::cos(angle), std::sin(angle)));
  }
  return points;
}

FlatPoints ring(const Gauge& gauge, Dice& dice) {
  const double r = gauge.radius_m;
  const double mean = gauge.length_m / kTurn;
  const double stretch = std::min(0.25, 0.3 * (mean / gauge.least_bend_m - 1));
  const double oval = dice.uniform(-1, 1) * std::max(0.0, stretch);
  const double three = dice.uniform(-0.3, 0.3) * std::max(0.0, stretch);
  const double phase = dice.uniform(0, kTurn);
  const bool overlap = dice.chance(0.4);  // the ends pass each other side by side
  const double gap = r * dice.uniform(2.03, 2.25);
  const double extra = overlap ? dice.uniform(6, 25) * r / mean : -gap / mean;
  FlatPoints points;
  for (double angle = 0; angle < kTurn + extra; angle += 0.25 * r / mean) {
    const double shape = 1 + oval * std::cos(2 * angle + phase) + three * std::cos(3 * angle);
    const double spiral = overlap ? gap * angle / kTurn : 0.0;
    points.emplace_back((mean * shape + spiral) * Vector2d(std::cos(angle), std::sin(angle)));
  }
  return points;
}

}  // namespace flowdlo::synth
