// Faults: what a sensor and a segmenter will get wrong in one scene.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "synth/dice.hpp"
#include "synth/view.hpp"

namespace flowdlo::synth {

/// Part of a rope, in samples of its curve.
struct Stretch {
  std::size_t rope = 0;
  double from = 0;
  double to = 0;

  [[nodiscard]] bool holds(std::size_t of, double sample) const {
    return of == rope && sample >= from && sample <= to;
  }
};

struct DepthFaults {
  bool noise = false;
  bool whole_mm = false;         ///< the sensor reports millimetres
  double flying = 0;             ///< share of border pixels between rope and background
  double dropout = 0;            ///< share of border pixels without depth
  int holes = 0;                 ///< round ones on the rope
  std::vector<Stretch> lost{};   ///< no depth at all
  std::vector<Stretch> black{};  ///< hardly any depth
  std::vector<Stretch> shiny{};  ///< no depth where the rope faces the camera
  std::vector<Stretch> sunk{};   ///< thin rope that takes on the background's depth
};

struct MaskFaults {
  int ragged_px = 0;           ///< reach of a frayed border, at 640 px of width
  bool frayed_inwards = true;  ///< false for a thin rope, which would fall apart
  int shift_px = 0;            ///< dilated (1) or eroded (-1)
  int specks = 0;
  std::vector<Stretch> gaps{};
  int parted_px = 0;  ///< mask that is missing beside a rope that lies on another one
};

struct Faults {
  DepthFaults depth;
  MaskFaults mask;
  bool bars = false;
  bool hand = false;
  bool clutter = false;
};

/// Of a scene of the wide split. Two scenes of five have sensor noise only.
[[nodiscard]] Faults draw_faults(std::span<const Rope> ropes, const View& view, bool dark,
                                 Dice& dice);

}  // namespace flowdlo::synth
