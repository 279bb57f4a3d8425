// Axes: the strands that a field shows, as lines of the frame.
#pragma once

#include <memory>
#include <vector>

#include "field/axis_line.hpp"
#include "field/strand_field.hpp"
#include "field/view.hpp"

namespace flowdlo::field {

/// Pixels of the frame.
struct Axes {
  std::vector<AxisLine> lines;  ///< the clearest first; points less than a pixel of the field apart
  float width_px = 0;           ///< of the rope
  float magnified_for_px = 0;   ///< the rope's width for which the field was magnified
  FieldView view{};             ///< what the field shows beside the lines
  std::shared_ptr<const weights::LinkWeights> links{};  ///< what links them; or null
};

[[nodiscard]] Axes axes(const StrandField& seen);

}  // namespace flowdlo::field
