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

struct Passage {
  double over = 0;  // samples
  double under = 0;
  double sine = 1;
};

std::pair<FlatPoints, double> evenly(const FlatPoints& flat, double spacing_m) {
  std::vector<Vector3d> points;
  points.reserve(flat.size());
  for (const Vector2d& p : flat) points.emplace_back(p.x(), p.y(), 0);
  const Curve curve = respaced(points, spacing_m);
  FlatPoints even;
  even.reserve(curve.points.size());
  for (const Vector3d& p : curve.points) even.emplace_back(p.x(), p.y());
  return {std::move(even), curve.step_m};
}

std::vector<Passage> passages(const FlatPoints& flat, bool in_order, Dice& dice) {
  std::vector<Passage> result;
  for (const Crossing& c : crossings(flat)) {
    const bool later_is_over = in_order || dice.chance(0.5);
    result.push_back(later_is_over ? Passage{c.second, c.first, c.sine}
                                   : Passage{c.first, c.second, c.sine});
  }
  return result;
}

double highest_around(const std::vector<double>& heights, double at, double reach) {
  const auto last = static_cast<double>(heights.size() - 1);
  const auto from = static_cast<std::size_t>(std::clamp(at - reach, 0.0, last));
  const auto to = static_cast<std::size_t>(std::clamp(at + reach, 0.0, last));
  return *std::max_element(heights.begin() + static_cast<std::ptrdiff_t>(from),
                           heights.begin() + static_cast<std::ptrdiff_t>(to) + 1);
}

// What the strand has to clear, as a height of its centerline over the table's.
void raise_obstacle(std::vector<double>& needed, const std::vector<double>& heights,
                    const Passage& passage, double radius, double step) {
  const double reach = kLift * radius / passage.sine / step;
  const double below = highest_around(heights, passage.under, 1.2 * reach);
  const double margin = 2 * kRounding * radius / step;
  const auto from = static_cast<std::ptrdiff_t>(std::ceil(passage.over - reach - margin));
  const auto to = static_cast<std::ptrdiff_t>(std::floor(passage.over + reach + margin));
  for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(0, from);
       i <= std::min<std::ptrdiff_t>(to, std::ssize(needed) - 1); ++i) {
    const double along = std::max(0.0, std::abs(static_cast<double>(i) - passage.over) - margin);
    const double across = along * step * passage.sine;
    const double lift = std::sqrt(std::max(0.0, std::pow(kLift * radius, 2) - across * across));
    auto& need = needed[static_cast<std::size_t>(i)];
    need = std::max(need, below + lift);
  }
}

// The lowest profile over `needed` that bends down no more than a rope of that stiffness.
std::vector<double> draped(const std::vector<double>& needed, double sag_m, double step) {
  std::vector<double> heights = needed;
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

void round_off(std::vector<double>& heights, int reach) {
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
void add_arches(std::vector<double>& heights, const std::vector<Passage>& all, const Gauge& gauge,
                const Laying& laying, double step, Dice& dice) {
  const double whole = static_cast<double>(heights.size()) * step;
  for (int k = 0; k < laying.arches; ++k) {
    const double height = laying.arch_m * dice.uniform(0.4, 1.0);
    // A raised cosine bends at most 2 pi^2 h / w^2.
    const double least = std::numbers::pi * std::sqrt(4 * height * gauge.least_bend_m);
    const double width = std::max(least, dice.uniform(0.1, 0.3) * whole);
    const double middle = dice.uniform(0, whole);
    const bool free = std::none_of(all.begin(), all.end(), [&](const Passage& p) {
      const double zone = 0.5 * width + 8 * gauge.radius_m;
      return std::abs(p.over * step - middle) < zone || std::abs(p.under * step - middle) < zone;
    });
    if (!free || width > 0.6 * whole) continue;
    for (std::size_t i = 0; i < heights.size(); ++i) {
      const double t = (static_cast<double>(i) * step - middle) / width;
      if (std::abs(t) >= 0.5) continue;
      heights[i] += height * 0.5 * (1 + std::cos(2 * std::numbers::pi * t));
    }
  }
}

}  // namespace

std::optional<Curve> laid(const FlatPoints& flat, const Gauge& gauge, const Laying& laying,
                          Dice& dice) {
  const double r = gauge.radius_m;
  const auto [even, step] = evenly(flat, 0.5 * r);
  const auto all = passages(even, laying.in_order, dice);
  const int rounding = std::max(1, static_cast<int>(std::lround(kRounding * r / step)));
  std::vector<double> heights(even.size(), 0);
  for (int round = 0; round < kRounds && !all.empty(); ++round) {
    std::vector<double> needed(even.size(), 0);
    for (const Passage& passage : all) raise_obstacle(needed, heights, passage, r, step);
    auto next = draped(needed, kSag * r, step);
    round_off(next, rounding);
    round_off(next, rounding);
    double change = 0;
    for (std::size_t i = 0; i < next.size(); ++i) {
      change = std::max(change, std::abs(next[i] - heights[i]));
    }
    heights = std::move(next);
    if (change < 0.01 * r) break;
    if (round + 1 == kRounds) return std::nullopt;  // strands that carry each other in a circle
  }
  if (*std::max_element(heights.begin(), heights.end()) > kHighest * r) return std::nullopt;
  add_arches(heights, all, gauge, laying, step, dice);
  std::vector<Vector3d> points;
  points.reserve(even.size());
  for (std::size_t i = 0; i < even.size(); ++i) {
    points.emplace_back(even[i].x(), even[i].y(), r + heights[i]);
  }
  return respaced(points, 0.5 * r);
}

}  // namespace flowdlo::synth
