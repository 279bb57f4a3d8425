// Cord: what a rope is made of and how it is coloured: a tube, or strands laid around each other,
// in one or two colours.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "synth/curve.hpp"
#include "synth/dice.hpp"
#include "synth/pixel_noise.hpp"

namespace flowdlo::synth {

enum class Pattern : std::uint8_t {
  kBraid,     ///< yarns that wind both ways show a little
  kTracers,   ///< yarns of the other colour wind around it
  kSpeckles,  ///< spots of the other colour
  kBands      ///< rings of the other colour
};

struct Cord {
  int strands = 1;        ///< laid around the axis; 1: a tube
  double turn_radii = 8;  ///< of laid strands and of tracers: along the rope, a turn
  bool left_handed = false;
  Pattern pattern = Pattern::kBraid;
  Vector3d color_bgr{0, 0, 0};
  Vector3d other_bgr{0, 0, 0};
  int others = 0;         ///< strands, or tracers, of the other colour
  double depth = 0.1;     ///< [0, 1] of the braid
  double share = 0.3;     ///< of speckles and bands: how much has the other colour
  double spot_radii = 1;  ///< of speckles and bands: how large
  double gloss = 20;      ///< of its highlight, grey values
  PixelNoise noise{0};

  /// Of each strand, in radii of the rope: together they fill a circle of one radius.
  [[nodiscard]] double strand_radii() const;

  /// How far around the axis strand `k` has wound after `along_radii`, radians.
  [[nodiscard]] double wound(int k, double along_radii) const;
};

[[nodiscard]] Cord draw_cord(Dice& dice);

/// The axes of the strands, a point for each of the curve's; of a tube the curve itself.
[[nodiscard]] std::vector<std::vector<Vector3d>> strand_axes(const Cord& cord, const Curve& curve,
                                                             double radius_m);

/// A place on a rope's surface, as its cord has it.
struct CordPlace {
  int strand = 0;
  double along_radii = 0;  ///< from the first end
  double angle_rad = 0;    ///< around the axis, from the way that a frame carried along has for 0
};

[[nodiscard]] Eigen::Vector3f color_at(const Cord& cord, const CordPlace& place);

/// How two sets of yarns that wind around a rope either way show at a place of it, [-1, 1].
[[nodiscard]] double weave(double along_radii, double angle_rad);

/// The first of two unit vectors across each of the curve's points, carried along without a turn;
/// the other one is the tangent's product with it.
[[nodiscard]] std::vector<Vector3d> carried_across(const Curve& curve);

}  // namespace flowdlo::synth
