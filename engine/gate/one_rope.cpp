#include "gate/one_rope.hpp"

#include <algorithm>

#include "gate/beyond_tips.hpp"
#include "gate/image_curve.hpp"
#include "gate/left_over.hpp"
#include "gate/strip_shape.hpp"

namespace flowdlo::gate {

namespace {

std::vector<Doubt> doubts(const OneRope& one, const OneRopeLimits& limits) {
  std::vector<Doubt> found;
  if (one.slender < limits.slender || one.sides < limits.sides) found.push_back(Doubt::kNoRope);
  if (one.explained < limits.explained ||
      one.left_over > std::max(limits.left_over, limits.left_share * one.slender)) {
    found.push_back(Doubt::kStrandsLeft);
  }
  if (one.bare_gap > std::max(limits.bare_gap, limits.bare_share * one.slender)) {
    found.push_back(Doubt::kBareGap);
  }
  if (one.goes_on >= limits.goes_on) found.push_back(Doubt::kGoesOn);
  return found;
}

}  // namespace

OneRope one_rope(const Centerline& nodes, const Frame& frame, float rope_width_px,
                 const OneRopeLimits& limits) {
  OneRope one;
  const ImageCurve curve = image_curve(nodes, frame, rope_width_px);
  if (curve.points.size() < 2) {
    one.doubts.push_back(Doubt::kNoRope);
    return one;
  }
  const StripShape strip = strip_shape(curve, frame);
  const LeftOver left = left_over(curve, strip.widening, frame);
  one.explained = left.explained;
  one.left_over = left.strands_widths;
  one.slender = curve.points.back().length_px / curve.width_px;
  one.sides = strip.sides;
  one.even = strip.even;
  one.off_mask = strip.off_mask;
  one.bare_gap = strip.bare_gap_widths;
  one.goes_on = beyond_tips(curve, frame);
  one.doubts = doubts(one, limits);
  return one;
}

float doubted(float confidence, const OneRope& one) {
  return one.doubts.empty() ? confidence : std::min(confidence, kDoubted);
}

}  // namespace flowdlo::gate
