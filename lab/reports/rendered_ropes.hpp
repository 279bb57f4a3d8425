// Rendered ropes: scenes of flowdlo synth's several split, or of one rope, as drawn ones are.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "flowdlo/result.hpp"
#include "scene/ropes.hpp"
#include "synth/synthetic_frame.hpp"

namespace flowdlo::lab {

struct RenderedRopes {
  std::string scenario;
  RopesScene scene;  ///< of each rope what lies between the first and the last place that shows
};

/// Scene `index` of that part of `split`, kSeveral, kTangled or kWide, with `cords` as
/// synth::Render has it; empty where a rope leaves the image and comes back, so that it is not
/// plain how many there are. Fails as synth::make_frame does.
[[nodiscard]] Result<std::optional<RenderedRopes>> rendered_ropes(synth::Split split,
                                                                  synth::Part part,
                                                                  std::uint64_t index,
                                                                  bool cords = false);

}  // namespace flowdlo::lab
