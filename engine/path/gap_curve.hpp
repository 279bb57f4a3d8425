// Gap curve: how the rope runs from one strand's end to another's where no mask shows it.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "path/cover.hpp"
#include "path/strands.hpp"

namespace flowdlo::path {

/// Of the cubics that leave one end along its direction and enter the other against its own, the
/// one that bends least and shows least before the background.
struct GapCurve {
  Eigen::Vector2f leaves_px{0, 0};  ///< derivative at `from`
  Eigen::Vector2f enters_px{0, 0};  ///< and at `to`
  float length_px = 0;
  float bending = 0;  ///< energy times length: the squared turn of an arc
  float open_px = 0;  ///< length where the sensor sees the background
};

/// `fine`: searched further, for drawing.
[[nodiscard]] GapCurve gap_curve(const StrandEnd& from, const StrandEnd& to, const Cover& cover,
                                 float scale_px, bool fine);

/// What the curve costs as a link, dimensionless; less for what the ends themselves say.
[[nodiscard]] float cost_of(const GapCurve& curve, float scale_px);

/// Points about a pixel apart, both ends left out.
[[nodiscard]] std::vector<Eigen::Vector2f> points_of(const GapCurve& curve, const StrandEnd& from,
                                                     const StrandEnd& to);

}  // namespace flowdlo::path
