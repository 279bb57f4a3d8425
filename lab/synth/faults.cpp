#include "synth/faults.hpp"

#include <algorithm>
#include <cmath>

namespace flowdlo::synth {
namespace {

Stretch around(double middle, double length) {
  return {middle - 0.5 * length, middle + 0.5 * length};
}

// `length` in shares of the rope.
Stretch anywhere(const Rope& rope, double least, double most, Dice& dice) {
  const auto count = static_cast<double>(rope.curve.points.size() - 1);
  return around(dice.uniform(0, count), dice.uniform(least, most) * count);
}

double width_px_of(const Rope& rope, const View& view) {
  return 2 * rope.radius_m * view.camera.fx / view.distance_m;
}

// A hole of which one border lies before a turn of z and the other behind it: a straight line
// across it is wrong.
void lose_turn(const Rope& rope, const View& view, Dice& dice, std::vector<Stretch>& lost) {
  const auto& points = view.curve.points;
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
  lost.push_back(around(middle, length));
}

DepthFaults draw_depth(const Rope& rope, const View& view, bool plain, bool dark, Dice& dice) {
  DepthFaults faults;
  faults.noise = dice.chance(0.9);
  faults.whole_mm = faults.noise && dice.chance(0.7);
  faults.flying = dice.chance(0.6) ? dice.uniform(0.05, plain ? 0.15 : 0.6) : 0.0;
  if (plain) return faults;
  const bool time_of_flight = view.sensor->principle == DepthPrinciple::kTimeOfFlight;
  faults.dropout = dice.chance(0.3) ? dice.uniform(0.1, 0.9) : 0.0;
  faults.holes = dice.chance(0.2) ? dice.integer(1, 6) : 0;
  if (dice.chance(0.15)) faults.lost.push_back(anywhere(rope, 0.04, 0.2, dice));
  if (dice.chance(0.25)) lose_turn(rope, view, dice, faults.lost);
  const double black = dark ? (time_of_flight ? 0.35 : 0.2) : 0.05;
  for (int k = dice.chance(black) ? dice.integer(1, 3) : 0; k > 0; --k) {
    faults.black.push_back(anywhere(rope, 0.05, 0.3, dice));
  }
  for (int k = dice.chance(0.08) ? dice.integer(1, 3) : 0; k > 0; --k) {
    faults.shiny.push_back(anywhere(rope, 0.05, 0.3, dice));
  }
  for (int k = width_px_of(rope, view) < 7 && dice.chance(0.4) ? dice.integer(1, 3) : 0; k > 0;
       --k) {
    faults.sunk.push_back(anywhere(rope, 0.02, 0.12, dice));
  }
  return faults;
}

// A thin rope is frayed less and never eroded: little of its mask would be left.
MaskFaults draw_mask(const Rope& rope, const View& view, Dice& dice) {
  const double width_px = width_px_of(rope, view);
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
      const auto count = static_cast<double>(rope.curve.points.size() - 1);
      faults.gaps.push_back(
          around(dice.uniform(0.03, 0.97) * count, radii * rope.radius_m / rope.curve.step_m));
    }
  }
  return faults;
}

}  // namespace

Faults draw_faults(const Rope& rope, const View& view, bool dark, Dice& dice) {
  const bool plain = dice.chance(0.4);
  Faults faults;
  faults.depth = draw_depth(rope, view, plain, dark, dice);
  faults.clutter = dice.chance(0.35);
  if (plain) return faults;
  faults.mask = draw_mask(rope, view, dice);
  faults.bars = dice.chance(0.25);
  faults.hand = dice.chance(0.15);
  return faults;
}

}  // namespace flowdlo::synth
