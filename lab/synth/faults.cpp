#include "synth/faults.hpp"

#include <algorithm>
#include <cmath>

namespace flowdlo::synth {
namespace {

using RopeList = std::span<const Rope>;

Stretch around(std::size_t rope, double middle, double length) {
  return {rope, middle - 0.5 * length, middle + 0.5 * length};
}

// `length` in shares of the rope.
Stretch anywhere(RopeList ropes, double least, double most, Dice& dice) {
  const std::size_t rope = dice.any_of(ropes.size());
  const auto count = static_cast<double>(ropes[rope].curve.points.size() - 1);
  return around(rope, dice.uniform(0, count), dice.uniform(least, most) * count);
}

// Of the thinnest.
double width_px_of(RopeList ropes, const View& view) {
  const auto thinnest =
      std::min_element(ropes.begin(), ropes.end(),
                       [](const Rope& a, const Rope& b) { return a.radius_m < b.radius_m; });
  return 2 * thinnest->radius_m * view.camera.fx / view.distance_m;
}

// A hole of which one border lies before a turn of z and the other behind it: a straight line
// across it is wrong.
void lose_turn(RopeList ropes, const View& view, Dice& dice, std::vector<Stretch>& lost) {
  const std::size_t which = dice.any_of(ropes.size());
  const Rope& rope = ropes[which];
  const auto& points = view.curves[which].points;
  const auto count = points.size();
  const auto window = static_cast<std::size_t>(std::max(8.0, 0.05 * static_cast<double>(count)));
  std::vector<double> turns;
  for (std::size_t i = window; i + window < count; ++i) {
    const double before = points[i].z() - points[i - window].z();
    const double after = points[i + window].z() - points[i].z();
    const bool turns_here = before * after < 0;
    if (turns_here && std::min(std::abs(before), std::abs(after)) > 1.5 * rope.radius_m) {
      turns.push_back(static_cast<double>(i));
    }
  }
  if (turns.empty()) return;
  const double middle =
      turns[static_cast<std::size_t>(dice.integer(0, static_cast<int>(turns.size()) - 1))];
  const double length = std::max(16.0, dice.uniform(0.06, 0.2) * static_cast<double>(count));
  lost.push_back(around(which, middle, length));
}

DepthFaults draw_depth(RopeList ropes, const View& view, bool plain, bool dark, Dice& dice) {
  DepthFaults faults;
  faults.noise = dice.chance(0.9);
  faults.whole_mm = faults.noise && dice.chance(0.7);
  faults.flying = dice.chance(0.6) ? dice.uniform(0.05, plain ? 0.15 : 0.6) : 0.0;
  if (plain) return faults;
  const bool time_of_flight = view.sensor->principle == DepthPrinciple::kTimeOfFlight;
  faults.dropout = dice.chance(0.3) ? dice.uniform(0.1, 0.9) : 0.0;
  faults.holes = dice.chance(0.2) ? dice.integer(1, 6) : 0;
  if (dice.chance(0.15)) faults.lost.push_back(anywhere(ropes, 0.04, 0.2, dice));
  if (dice.chance(0.25)) lose_turn(ropes, view, dice, faults.lost);
  const double black = dark ? (time_of_flight ? 0.35 : 0.2) : 0.05;
  for (int k = dice.chance(black) ? dice.integer(1, 3) : 0; k > 0; --k) {
    faults.black.push_back(anywhere(ropes, 0.05, 0.3, dice));
  }
  for (int k = dice.chance(0.08) ? dice.integer(1, 3) : 0; k > 0; --k) {
    faults.shiny.push_back(anywhere(ropes, 0.05, 0.3, dice));
  }
  for (int k = width_px_of(ropes, view) < 7 && dice.chance(0.4) ? dice.integer(1, 3) : 0; k > 0;
       --k) {
    faults.sunk.push_back(anywhere(ropes, 0.02, 0.12, dice));
  }
  return faults;
}

// A thin rope is frayed less and never eroded: little of its mask would be left.
MaskFaults draw_mask(RopeList ropes, const View& view, Dice& dice) {
  const double width_px = width_px_of(ropes, view);
  MaskFaults faults;
  const double width_vga_px = width_px * 640 / view.sensor->width;
  const int most = std::clamp(static_cast<int>(width_vga_px / 4), 1, 3);
  faults.ragged_px = dice.chance(0.28) ? dice.integer(1, most) : 0;
  faults.frayed_inwards = width_vga_px > 6;
  faults.shift_px = dice.chance(0.3) ? (width_px < 5 || dice.chance(0.6) ? 1 : -1) : 0;
  faults.specks = dice.chance(0.12) ? dice.integer(1, 10) : 0;
  if (dice.chance(0.12)) {
    for (int k = dice.integer(1, 3); k > 0; --k) {
      const double radii = dice.uniform(0.8, 6.0);
      const std::size_t which = dice.any_of(ropes.size());
      const Rope& rope = ropes[which];
      const auto count = static_cast<double>(rope.curve.points.size() - 1);
      faults.gaps.push_back(around(which, dice.uniform(0.03, 0.97) * count,
                                   radii * rope.radius_m / rope.curve.step_m));
    }
  }
  return faults;
}

}  // namespace

Faults draw_faults(std::span<const Rope> ropes, const View& view, bool dark, Dice& dice) {
  const bool plain = dice.chance(0.4);
  Faults faults;
  faults.depth = draw_depth(ropes, view, plain, dark, dice);
  faults.clutter = dice.chance(0.35);
  // Ropes that were segmented one by one, and put into one mask, often do not touch there.
  if (ropes.size() > 1 && dice.chance(0.25)) faults.mask.parted_px = dice.integer(1, 2);
  if (plain) return faults;
  const int parted_px = faults.mask.parted_px;
  faults.mask = draw_mask(ropes, view, dice);
  faults.mask.parted_px = parted_px;
  faults.bars = dice.chance(0.25);
  faults.hand = dice.chance(0.15);
  return faults;
}

}  // namespace flowdlo::synth
