// The sets of ropes of the splits several and tangled: what lies, or hangs, in one picture and one
// mask.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "synth/flat_shape.hpp"
#include "synth/hanging_rope.hpp"
#include "synth/laid_rope.hpp"
#include "synth/rope.hpp"

namespace flowdlo::synth {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr int kPlacings = 40;       // of one rope
constexpr double kTouching = 1.01;  // sums of two radii between ropes that touch
constexpr double kClear = 1.06;     // and between ropes that do not
constexpr double kBeside = 0.5 * (1 + kTouching);
constexpr double kAlong = 0.25;        // share of ropes thrown that run along the first one
constexpr double kSeparation = 0.975;  // sums of two radii between ropes, in space

// How ropes may cross each other.
struct Order {
  double flattest;   // sine of the flattest crossing
  double clear_end;  // radii between an end and a crossing
};

constexpr Order kTidy = {0.35, 4.0};
constexpr Order kTangled = {0.15, 1.5};

int count_of(Dice& dice) {
  const std::size_t group = dice.pick({0.35, 0.3, 0.15, 0.1, 0.1});
  return group < 4 ? 2 + static_cast<int>(group) : dice.integer(6, 9);
}

// Slender, and not so long that several of them are no more than hairs in the picture.
Gauge gauge_of(Dice& dice) {
  Gauge gauge;
  gauge.radius_m = dice.log_uniform(0.0015, 0.008);
  gauge.length_m = gauge.radius_m * dice.log_uniform(60, 350);
  gauge.least_bend_m = gauge.radius_m * dice.log_uniform(5.0, 14.0);
  return gauge;
}

// How thick one rope is beside another one of its own kind.
struct Sizes {
  double least;
  double most;
};

constexpr Sizes kTidySizes = {0.6, 1.6};
constexpr Sizes kTangledSizes = {0.4, 2.5};

// All of one kind, or each of its own.
std::vector<Gauge> gauges_of(int count, const Sizes& sizes, Dice& dice) {
  const Gauge first = gauge_of(dice);
  const bool alike = dice.chance(0.5);
  std::vector<Gauge> gauges{first};
  for (int k = 1; k < count; ++k) {
    Gauge gauge = first;
    const double size = alike ? 1.0 : dice.log_uniform(sizes.least, sizes.most);
    gauge.radius_m *= size;
    gauge.least_bend_m *= size;
    gauge.length_m *= dice.log_uniform(0.6, 1.6);
    gauges.push_back(gauge);
  }
  return gauges;
}

Vector2d middle_of(const FlatPoints& points) {
  Vector2d low = points.front();
  Vector2d high = low;
  for (const Vector2d& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  return 0.5 * (low + high);
}

void put(FlatPoints& points, const Vector2d& middle) {
  const Vector2d by = middle - middle_of(points);
  for (Vector2d& p : points) p += by;
}

// Of points that are apart by less than half a radius.
double length_of(const FlatPoints& points) {
  double length = 0;
  for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
  return length;
}

FlatPoints closed_ring(const Gauge& gauge, Dice& dice) {
  const double mean = std::max(gauge.length_m / kTurn, 2 * gauge.least_bend_m);
  const double oval = dice.uniform(0, 0.2);
  const double three = dice.uniform(-0.06, 0.06);
  const double phase = dice.uniform(0, kTurn);
  const double start = dice.uniform(0, kTurn);
  const auto count = static_cast<std::size_t>(std::ceil(kTurn * mean / (0.25 * gauge.radius_m)));
  FlatPoints points;
  for (std::size_t i = 0; i <= count; ++i) {
    const double angle =
        start + kTurn * static_cast<double>(i % count) / static_cast<double>(count);
    const double r = mean * (1 + oval * std::cos(2 * angle + phase) + three * std::cos(3 * angle));
    points.emplace_back(r * Vector2d(std::cos(angle), std::sin(angle)));
  }
  return points;
}

// A line that goes on from a place, bending away evenly.
void go_on(FlatPoints& points, double heading, double bend, double length, double step) {
  for (double s = 0; s < length; s += step) {
    heading += bend * step;
    points.emplace_back(points.back() + step * Vector2d(std::cos(heading), std::sin(heading)));
  }
}

// Runs along a part of `other`, touching it, and leaves it at both ends or ends there.
FlatPoints beside(const FlatRope& other, const Gauge& gauge, Dice& dice) {
  const auto& line = other.points;
  const double last = static_cast<double>(line.size() - 1);
  const double from = dice.uniform(0.05, 0.6) * last;
  const double to = std::min(last - 4, from + dice.uniform(0.12, 0.5) * last);
  const double apart =
      (gauge.radius_m + other.gauge.radius_m) * dice.uniform(kTouching, kTouching + 0.12);
  const double hand = dice.sign();
  const double step = 0.25 * gauge.radius_m;
  const auto heading_at = [&](std::size_t i) {
    const std::size_t before = i < 3 ? 0 : i - 3;
    const Vector2d along = line[std::min(i + 3, line.size() - 1)] - line[before];
    return std::atan2(along.y(), along.x());
  };
  const auto place = [&](std::size_t i) -> Vector2d {
    const double heading = heading_at(i);
    return line[i] + apart * hand * Vector2d(-std::sin(heading), std::cos(heading));
  };
  const auto first = static_cast<std::size_t>(from);
  const auto final = static_cast<std::size_t>(to);
  const auto away = [&] { return dice.uniform(0.4, 1.0) / gauge.least_bend_m; };
  const auto tail = [&] {
    return dice.chance(0.2) ? 0.0 : dice.uniform(0.1, 0.45) * gauge.length_m;
  };
  FlatPoints points{place(first)};
  go_on(points, heading_at(first) + std::numbers::pi, -hand * away() * 0.5, tail(), step);
  std::reverse(points.begin(), points.end());
  for (std::size_t i = first + 1; i <= final; ++i) points.push_back(place(i));
  go_on(points, heading_at(final), hand * away() * 0.5, tail(), step);
  return points;
}

// Near each other at crossings alone, which lie as `order` has it; `apart` in sums of radii.
bool lies_well(const FlatRope& a, const FlatRope& b, const Order& order, double apart,
               bool& cross) {
  const auto all = crossings(a.points, b.points);
  const double step_a = length_of(a.points) / static_cast<double>(a.points.size() - 1);
  const double step_b = length_of(b.points) / static_cast<double>(b.points.size() - 1);
  const auto inside = [&](double at, const FlatRope& rope, double step) {
    const double end = order.clear_end * rope.gauge.radius_m / step;
    return at > end && at < static_cast<double>(rope.points.size() - 1) - end;
  };
  for (const Crossing& c : all) {
    if (c.sine < order.flattest || !inside(c.first, a, step_a) || !inside(c.second, b, step_b)) {
      return false;
    }
  }
  cross = cross || !all.empty();
  const double near = apart * (a.gauge.radius_m + b.gauge.radius_m);
  for (std::size_t i = 0; i < a.points.size(); ++i) {
    for (std::size_t j = 0; j < b.points.size(); ++j) {
      const double distance = (a.points[i] - b.points[j]).norm();
      if (distance > near) {  // no nearer for as many samples as the distance takes
        j += static_cast<std::size_t>((distance - near) / std::max(step_b, 1e-9) * 0.9);
        continue;
      }
      const bool known = std::any_of(all.begin(), all.end(), [&](const Crossing& c) {
        const double zone = 1.5 * near * (1 / c.sine + 1);
        return std::abs(static_cast<double>(i) - c.first) * step_a < zone &&
               std::abs(static_cast<double>(j) - c.second) * step_b < zone;
      });
      if (!known) return false;
    }
  }
  return true;
}

// The same of all others, from the first of which the rope may be nearer.
bool lies_well(const std::vector<FlatRope>& others, const FlatRope& rope, const Order& order,
               double apart_from_first, double apart, bool& cross) {
  return std::all_of(others.begin(), others.end(), [&](const FlatRope& other) {
    const bool first = &other == &others.front();
    return lies_well(other, rope, order, first ? apart_from_first : apart, cross);
  });
}

// Anywhere around the middle of one of the others, at most `share` of half the first one's length
// away.
void put_near(FlatPoints& points, const std::vector<FlatRope>& others, double share, Dice& dice) {
  const double reach = 0.5 * others.front().gauge.length_m * std::sqrt(dice.uniform(0, 1));
  const double angle = dice.uniform(0, kTurn);
  put(points, middle_of(others[dice.any_of(others.size())].points) +
                  share * reach * Vector2d(std::cos(angle), std::sin(angle)));
}

// A shape for the next rope, in its place among the others. Empty when none was found.
std::optional<FlatRope> placed(const std::vector<FlatRope>& others, const Gauge& gauge, bool closed,
                               bool touching, bool joined, Dice& dice) {
  const double clear = dice.chance(0.5) ? kClear : 1.35;  // just apart, or well apart
  for (int k = 0; k < kPlacings; ++k) {
    FlatRope rope{{}, gauge, closed};
    if (closed) {
      rope.points = closed_ring(gauge, dice);
    } else if (touching) {
      rope.points = beside(others.front(), gauge, dice);
    } else {
      const Heading heading{.turn = dice.uniform(0, 5),
                            .wander = dice.uniform(0.1, 3),
                            .most_crossings = dice.chance(0.3) ? 2 : 0};
      auto shape = wandering(gauge, heading, dice);
      if (!shape) continue;
      rope.points = std::move(*shape);
    }
    if (!touching && !others.empty()) {
      put_near(rope.points, others, 0.6, dice);
    }
    bool cross = others.empty() || touching;
    const bool fits = lies_well(others, rope, kTidy, touching ? kBeside : clear, clear, cross);
    if (fits && (cross || !joined)) return rope;
  }
  return std::nullopt;
}

std::optional<Ropes> laid_down(const std::vector<FlatRope>& flat, Dice& dice) {
  Laying laying{.in_order = dice.chance(0.6)};
  auto curves = laid_together(flat, laying, dice);
  if (!curves) return std::nullopt;
  Ropes ropes(flat.size());
  for (std::size_t k = 0; k < flat.size(); ++k) {
    ropes[k].curve = std::move((*curves)[k]);
    ropes[k].closed = flat[k].closed;
  }
  return ropes;
}

std::optional<Ropes> on_a_table(std::string_view scenario, const std::vector<Gauge>& gauges,
                                Dice& dice) {
  std::vector<FlatRope> flat;
  const bool joined = dice.chance(0.85);  // each one crosses another one
  for (std::size_t k = 0; k < gauges.size(); ++k) {
    const bool ring = scenario == "ropes-ring" && k == 0;
    const bool touching = scenario == "ropes-touching" && k == 1;
    auto rope = placed(flat, gauges[k], ring, touching, joined, dice);
    if (!rope) return std::nullopt;
    rope->gauge.length_m = length_of(rope->points);
    flat.push_back(*std::move(rope));
  }
  return laid_down(flat, dice);
}

enum class Shape { kLoops, kCoil, kFold, kKnotted, kGentle };

Shape shape_of(std::string_view scenario, bool first, Dice& dice) {
  constexpr std::array kShapes{Shape::kLoops, Shape::kCoil, Shape::kFold, Shape::kKnotted,
                               Shape::kGentle};
  if (scenario == "tangled-loops") return kShapes[first ? 0 : dice.pick({45, 0, 0, 20, 35})];
  if (scenario == "tangled-coils") return kShapes[first ? 1 : dice.pick({15, 20, 10, 10, 45})];
  if (scenario == "tangled-flat") return kShapes[dice.pick({5, 0, 5, 5, 85})];
  return kShapes[dice.pick({25, 10, 10, 20, 35})];
}

std::optional<FlatPoints> shaped(Shape shape, Gauge& gauge, Dice& dice) {
  if (shape == Shape::kLoops) {
    gauge.length_m = gauge.radius_m * dice.log_uniform(110, 400);
    return looped(gauge, 1 + static_cast<int>(dice.pick({0.6, 0.3, 0.1})), dice);
  }
  if (shape == Shape::kCoil) {
    gauge.length_m = gauge.radius_m * dice.log_uniform(130, 400);
    return coil(gauge, dice);
  }
  if (shape == Shape::kFold) {
    gauge.length_m = gauge.radius_m * dice.log_uniform(90, 350);
    return doubled(gauge, dice.chance(0.5), dice);
  }
  if (shape == Shape::kKnotted) {
    gauge.length_m = gauge.radius_m * dice.log_uniform(90, 400);
    const Heading heading{.turn = dice.uniform(4, 9),
                          .wander = dice.uniform(1.5, 5),
                          .least_crossings = 1,
                          .most_crossings = 5};
    return wandering(gauge, heading, dice);
  }
  return wandering(gauge, {.turn = dice.uniform(0, 3), .wander = dice.uniform(0.1, 2)}, dice);
}

std::optional<FlatRope> thrown(std::string_view scenario, const std::vector<FlatRope>& others,
                               const Gauge& gauge, Dice& dice) {
  for (int k = 0; k < kPlacings; ++k) {
    FlatRope rope{{}, gauge, false};
    const bool along = !others.empty() && dice.chance(kAlong);
    if (along) {
      rope.points = beside(others.front(), gauge, dice);
      rope.gauge.length_m = length_of(rope.points);
    } else {
      auto shape = shaped(shape_of(scenario, others.empty(), dice), rope.gauge, dice);
      if (!shape) continue;
      rope.points = std::move(*shape);
      rope.gauge.length_m = length_of(rope.points);
      const double turn = dice.uniform(0, kTurn);
      for (Vector2d& p : rope.points) p = Eigen::Rotation2Dd(turn) * p;
      if (others.empty()) return rope;
      put_near(rope.points, others, 0.4, dice);
    }
    bool cross = along;
    const bool fits = lies_well(others, rope, kTangled, along ? kBeside : kClear, kClear, cross);
    if (fits && cross) return rope;
  }
  return std::nullopt;
}

std::optional<Ropes> thrown_together(std::string_view scenario, const std::vector<Gauge>& gauges,
                                     Dice& dice) {
  std::vector<FlatRope> flat;
  for (const Gauge& gauge : gauges) {
    auto rope = thrown(scenario, flat, gauge, dice);
    if (!rope) return std::nullopt;
    flat.push_back(*std::move(rope));
  }
  return laid_down(flat, dice);
}

// One before the other, each from grippers of its own.
Ropes in_the_air(const std::vector<Gauge>& gauges, Dice& dice) {
  Ropes ropes;
  double out_m = 0;
  for (const Gauge& gauge : gauges) {
    const Hanging hanging{.two_grippers = dice.chance(0.75),
                          .loops = dice.chance(0.2) ? 1 : 0,
                          .swing_m = dice.uniform(0, 0.05) * gauge.length_m};
    Rope rope;
    rope.hanging = true;
    rope.grippers = hanging.two_grippers ? 2 : 1;
    rope.curve = hung(gauge, hanging, dice);
    const double size = gauges.front().length_m;
    const Vector3d by(dice.uniform(-0.25, 0.25) * size, dice.uniform(-0.15, 0.15) * size, out_m);
    for (Vector3d& p : rope.curve.points) p += by;
    out_m += dice.log_uniform(4 * gauge.radius_m, 0.08);
    ropes.push_back(std::move(rope));
  }
  return ropes;
}

bool apart(const Ropes& ropes) {
  for (std::size_t a = 0; a < ropes.size(); ++a) {
    for (std::size_t b = a + 1; b < ropes.size(); ++b) {
      const double sum = ropes[a].radius_m + ropes[b].radius_m;
      if (distance_m(ropes[a].curve, ropes[b].curve, sum) < kSeparation * sum) return false;
    }
  }
  return true;
}

// As they are to be, longest first. Empty where one is not, or where two run through each other.
std::optional<Ropes> finished(std::optional<Ropes> ropes, std::string_view scenario,
                              const std::vector<Gauge>& gauges, bool square_ends) {
  if (!ropes) return std::nullopt;
  for (std::size_t k = 0; k < gauges.size(); ++k) {
    Rope& rope = (*ropes)[k];
    rope.scenario = scenario;
    rope.radius_m = gauges[k].radius_m;
    rope.square_ends = square_ends && !rope.closed;
    if (!sound(rope)) return std::nullopt;
  }
  if (!apart(*ropes)) return std::nullopt;
  std::stable_sort(ropes->begin(), ropes->end(), [](const Rope& a, const Rope& b) {
    return a.curve.length_m() > b.curve.length_m();
  });
  return ropes;
}

}  // namespace

std::optional<Ropes> try_several_ropes(std::string_view scenario, Dice& dice) {
  const auto gauges = gauges_of(count_of(dice), kTidySizes, dice);
  const bool square_ends = dice.chance(0.5);
  return finished(scenario == "ropes-hanging" ? std::optional(in_the_air(gauges, dice))
                                              : on_a_table(scenario, gauges, dice),
                  scenario, gauges, square_ends);
}

std::optional<Ropes> try_tangled_ropes(std::string_view scenario, Dice& dice) {
  const int count = 2 + static_cast<int>(dice.pick({0.35, 0.3, 0.2, 0.1, 0.05}));
  const auto gauges = gauges_of(count, kTangledSizes, dice);
  const bool square_ends = dice.chance(0.5);
  return finished(thrown_together(scenario, gauges, dice), scenario, gauges, square_ends);
}

}  // namespace flowdlo::synth
