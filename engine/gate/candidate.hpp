// Candidate: a centerline that an estimate may return, and what is known about it without truth.
#pragma once

#include <array>

#include "flowdlo/centerline.hpp"
#include "gate/axes_score.hpp"
#include "gate/tube_score.hpp"

namespace flowdlo::gate {

/// A prior, or a draw's prediction beside the prior that conditioned it.
struct Candidate {
  Centerline nodes{};
  std::array<float, kNodes> sigma_m{};   ///< a prior's own, or what the model says of its draw
  int draw = -1;                         ///< -1: a prior
  int hypothesis = 0;                    ///< index of the prior's candidate, best score first
  float radius_m = 0;                    ///< of the rope, as the mask has it
  float pixel_m = 0;                     ///< what a pixel spans at the rope's depth
  float noise_m = 0;                     ///< standard deviation of the depths on the mask
  std::array<float, kNodes> unseen_m{};  ///< along the rope to the nearest node with support
  TubeScore tube;       ///< how it looks beside mask and depth; the worst where it cannot be drawn
  double behind = 0;    ///< score by which its traversal trails the best of the mask as given
  int readings = 1;     ///< of the mask, that of the mask as given among them
  bool reread = false;  ///< only another reading than that of the mask as given led here
  float votes = 1;      ///< [0, 1] share of the readings whose best traversal runs here
  float odds = 1;       ///< [0, 1] mean over the readings of how likely each says it is
  float seen_odds = 0;  ///< [0, 1] how likely the closest look through the strand field says it is
  AxesScore axes;       ///< how it agrees with the strand field
  float supported = 0;  ///< [0, 1] share of nodes with support
  float bridged = 0;    ///< [0, 1] share of its traversal on links over gaps
  float longest_gap = 0;  ///< of its traversal, rope widths
  float hidden_ends = 0;  ///< [0, 1] half for each tip where an occluder begins
  float buried_ends = 0;  ///< [0, 1] half for each end on another strand
  float ring = 0;         ///< 1: the traversal is closed, its ends are a guess
  float length_off = 0;   ///< |log of its length against the known one|; 0 where none is known
};

}  // namespace flowdlo::gate
