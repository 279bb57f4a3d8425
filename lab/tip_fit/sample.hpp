// TipSample: an end of a hypothesis beside the rope's tip, as the network of refine/tips is fitted
// to them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "field/network.hpp"
#include "flowdlo/centerline.hpp"
#include "refine/tips.hpp"
#include "synth/synthetic_frame.hpp"

namespace flowdlo::lab {

struct TipSample {
  std::uint64_t index = 0;
  std::string kind;  ///< of the scene
  refine::TipFeatures features{};
  float beyond_widths = 0;  ///< the tip beyond the end; negative: before it
};

/// How far along the rope the tip at the truth's first node lies beyond the hypothesis' first node,
/// metres; negative: before it. Nothing where neither is near the other's curve (`near_m`): the end
/// is another strand's.
[[nodiscard]] std::optional<double> beyond_m(const Centerline& nodes, const Centerline& truth,
                                             double near_m);

/// Both ends of each hypothesis of the frame's first reading that is about right and no ring; none
/// where the strand field shows nothing.
[[nodiscard]] std::vector<TipSample> samples_of(const synth::SyntheticFrame& scene,
                                                field::Network& network);

/// The same of each rope that is told apart in a scene of several, in its own view.
[[nodiscard]] std::vector<TipSample> samples_of_ropes(const synth::SyntheticFrame& scene,
                                                      field::Network& network);

}  // namespace flowdlo::lab
