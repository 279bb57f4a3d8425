#include "synth/laid_rope.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace flowdlo::synth {
namespace {

constexpr double kLift = 2.06;     // radii between the strands' centerlines at a crossing
constexpr double kHighest = 7.0;   // radii that a pile of crossings may reach
constexpr double kSag = 12.0;      // radii of curvature of the rope over a strand
constexpr double kRounding = 1.6;  // radii over which a corner of the profile is rounded
constexpr int kRounds = 8;

// A place on a rope.
struct Place {
  std::size_t rope = 0;
  double at = 0;  // samples
};

struct Passage {
  Place over;
  Place under;
  double sine = 1;
};

// A rope with samples that are half a radius apart.
struct Even {
  FlatPoints points;
  double step_m = 0;
  double radius_m = 0;
};

using Heights = std::vector<double>;  // of a rope's samples, over those of a rope on the table

Even evenly(const FlatRope& rope) {
  std::vector<Vector3d> points;
  points.reserve(rope.points.size());
  for (const Vector2d& p : rope.points) points.emplace_back(p.x(), p.y(), 0);
  const Curve curve = respaced(points, 0.5 * rope.gauge.radius_m);
  Even even{{}, curve.step_m, rope.gauge.radius_m};
  even.points.reserve(curve.points.size());
  for (const Vector3d& p : curve.points) even.points.emplace_back(p.x(), p.y());
  return even;
}

std::vector<Passage> passages(std::span<const FlatRope> ropes, const std::vector<Even>& even,
                              bool in_order, Dice& dice) {
  std::vector<Passage> result;
  for (std::size_t a = 0; a < even.size(); ++a) {
    for (std::size_t b = a; b < even.size(); ++b) {
      const auto all =
          a == b ? crossings(even[a].points) : crossings(even[a].points, even[b].points);
      const auto last = static_cast<double>(even[a].points.size() - 1);
      for (const Crossing& c : all) {
        // A ring's ends meet.
        if (a == b && ropes[a].closed && c.first < 1 && c.second > last - 1) continue;
        const bool later_is_over = in_order || dice.chance(0.5);
        const Place first{a, c.first};
        const Place second{b, c.second};
        result.push_back(later_is_over ? Passage{second, first, c.sine}
                                       : Passage{first, second, c.sine});
      }
    }
  }
  return result;
}

double highest_around(const Heights& heights, double at, double reach) {
  const auto last = static_cast<double>(heights.size() - 1);
  const auto from = static_cast<std::size_t>(std::clamp(at - reach, 0.0, last));
  const auto to = static_cast<std::size_t>(std::clamp(at + reach, 0.0, last));
  return *std::max_element(heights.begin() + static_cast<std::ptrdiff_t>(from),
                           heights.begin() + static_cast<std::ptrdiff_t>(to) + 1);
}

// What the strand has to clear, as a height of its centerline over the table's.
void raise_obstacle(std::vector<Heights>& needed, const std::vector<Heights>& heights,
                    const std::vector<Even>& ropes, const Passage& passage) {
  const Even& upper = ropes[passage.over.rope];
  const Even& lower = ropes[passage.under.rope];
  const double lift_m = kLift * (0.5 * (upper.radius_m + lower.radius_m));
  const double reach = lift_m / passage.sine / upper.step_m;
  const double below = highest_around(heights[passage.under.rope], passage.under.at,
                                      1.2 * (lift_m / passage.sine / lower.step_m)) +
                       (lower.radius_m - upper.radius_m);
  const double margin = 2 * kRounding * upper.radius_m / upper.step_m;
  const auto from = static_cast<std::ptrdiff_t>(std::ceil(passage.over.at - reach - margin));
  const auto to = static_cast<std::ptrdiff_t>(std::floor(passage.over.at + reach + margin));
  Heights& profile = needed[passage.over.rope];
  for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(0, from);
       i <= std::min<std::ptrdiff_t>(to, std::ssize(profile) - 1); ++i) {
    const double along = std::max(0.0, std::abs(static_cast<double>(i) - passage.over.at) - margin);
    const double across = along * upper.step_m * passage.sine;
    const double lift = std::sqrt(std::max(0.0, std::pow(lift_m, 2) - across * across));
    auto& need = profile[static_cast<std::size_t>(i)];
    need = std::max(need, below + lift);
  }
}

// The lowest profile over `needed` that bends down no more than a rope of that stiffness.
Heights draped(const Heights& needed, double sag_m, double step) {
  Heights heights = needed;
  const auto count = std::ssize(needed);
  for (std::ptrdiff_t i = 0; i < count; ++i) {
    const double top = needed[static_cast<std::size_t>(i)];
    if (top <= 0) continue;
    const auto reach = static_cast<std::ptrdiff_t>(std::sqrt(2 * top * sag_m) / step);
    for (std::ptrdiff_t j = std::max<std::ptrdiff_t>(0, i - reach);
         j <= std::min(count - 1, i + reach); ++j) {
      const double away = static_cast<double>(j - i) * step;
      auto& height = heights[static_cast<std::size_t>(j)];
      height = std::max(height, top - away * away / (2 * sag_m));
    }
  }
  return heights;
}

void round_off(Heights& heights, int reach) {
  const auto count = static_cast<int>(heights.size());
  std::vector<double> sums(heights.size() + 1, 0);
  for (int i = 0; i < count; ++i) sums[i + 1] = sums[i] + heights[i];
  for (int i = 0; i < count; ++i) {
    const int low = std::max(0, i - reach);
    const int high = std::min(count - 1, i + reach);
    heights[i] = (sums[high + 1] - sums[low]) / (high - low + 1);
  }
}

// Smooth arches with no strand across them, so that nothing has to be carried.
void add_arches(Heights& heights, std::size_t rope, const std::vector<Passage>& all,
                const Gauge& gauge, const Laying& laying, double step, Dice& dice) {
  const double whole = static_cast<double>(heights.size()) * step;
  for (int k = 0; k < laying.arches; ++k) {
    const double height = laying.arch_m * dice.uniform(0.4, 1.0);
    // A raised cosine bends at most 2 pi^2 h / w^2.
    const double least = std::numbers::pi * std::sqrt(4 * height * gauge.least_bend_m);
    const double width = std::max(least, dice.uniform(0.1, 0.3) * whole);
    const double middle = dice.uniform(0, whole);
    const bool free = std::none_of(all.begin(), all.end(), [&](const Passage& p) {
      const double zone = 0.5 * width + 8 * gauge.radius_m;
      return (p.over.rope == rope && std::abs(p.over.at * step - middle) < zone) ||
             (p.under.rope == rope && std::abs(p.under.at * step - middle) < zone);
    });
    if (!free || width > 0.6 * whole) continue;
    for (std::size_t i = 0; i < heights.size(); ++i) {
      const double t = (static_cast<double>(i) * step - middle) / width;
      if (std::abs(t) >= 0.5) continue;
      heights[i] += height * 0.5 * (1 + std::cos(2 * std::numbers::pi * t));
    }
  }
}

// Heights at which every strand lies on those below it. Empty where strands carry each other in a
// circle, or pile up.
std::optional<std::vector<Heights>> settled(const std::vector<Even>& ropes,
                                            const std::vector<Passage>& all) {
  std::vector<Heights> heights;
  for (const Even& rope : ropes) heights.emplace_back(rope.points.size(), 0);
  for (int round = 0; round < kRounds && !all.empty(); ++round) {
    std::vector<Heights> needed;
    for (const Even& rope : ropes) needed.emplace_back(rope.points.size(), 0);
    for (const Passage& passage : all) raise_obstacle(needed, heights, ropes, passage);
    double change = 0;  // radii
    for (std::size_t k = 0; k < ropes.size(); ++k) {
      const Even& rope = ropes[k];
      auto next = draped(needed[k], kSag * rope.radius_m, rope.step_m);
      const int rounding =
          std::max(1, static_cast<int>(std::lround(kRounding * rope.radius_m / rope.step_m)));
      round_off(next, rounding);
      round_off(next, rounding);
      for (std::size_t i = 0; i < next.size(); ++i) {
        change = std::max(change, std::abs(next[i] - heights[k][i]) / rope.radius_m);
      }
      heights[k] = std::move(next);
    }
    if (change < 0.01) break;
    if (round + 1 == kRounds) return std::nullopt;
  }
  for (std::size_t k = 0; k < ropes.size(); ++k) {
    const double highest = *std::max_element(heights[k].begin(), heights[k].end());
    if (highest > kHighest * ropes[k].radius_m) return std::nullopt;
  }
  return heights;
}

}  // namespace

std::optional<std::vector<Curve>> laid_together(std::span<const FlatRope> ropes,
                                                const Laying& laying, Dice& dice) {
  std::vector<Even> even;
  for (const FlatRope& rope : ropes) even.push_back(evenly(rope));
  const auto all = passages(ropes, even, laying.in_order, dice);
  auto heights = settled(even, all);
  if (!heights) return std::nullopt;
  std::vector<Curve> curves;
  for (std::size_t k = 0; k < ropes.size(); ++k) {
    Heights& profile = (*heights)[k];
    const double r = ropes[k].gauge.radius_m;
    if (ropes[k].closed && std::max(profile.front(), profile.back()) > 0) return std::nullopt;
    add_arches(profile, k, all, ropes[k].gauge, laying, even[k].step_m, dice);
    std::vector<Vector3d> points;
    points.reserve(profile.size());
    for (std::size_t i = 0; i < profile.size(); ++i) {
      points.emplace_back(even[k].points[i].x(), even[k].points[i].y(), r + profile[i]);
    }
    curves.push_back(respaced(points, 0.5 * r));
  }
  return curves;
}

std::optional<Curve> laid(const FlatPoints& flat, const Gauge& gauge, const Laying& laying,
                          Dice& dice) {
  const FlatRope rope{flat, gauge};
  auto curves = laid_together({&rope, 1}, laying, dice);
  if (!curves) return std::nullopt;
  return std::move(curves->front());
}

}  // namespace flowdlo::synth
