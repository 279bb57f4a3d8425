// Labels: the strands that a field shows in a scene with truth, and where each end really goes on.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "field/axes.hpp"
#include "field/network.hpp"
#include "flowdlo/frame.hpp"
#include "flowdlo/result.hpp"
#include "path/region.hpp"
#include "path/second_opinion.hpp"
#include "path/strands.hpp"
#include "synth/synthetic_frame.hpp"

namespace flowdlo::lab {

/// What an end's partner is where it has none: its rope ends there,
inline constexpr int kStops = -1;
/// or its strand lies on no rope, or on what cannot be told.
inline constexpr int kUnknown = -2;

/// Scenes with more strands than that teach nothing but noise.
inline constexpr std::size_t kMostStrands = 60;

/// Whether one of the ropes has no ends.
[[nodiscard]] bool has_ring(const synth::SyntheticFrame& scene);

/// Stays where it is: its members borrow one another.
struct Labelled {
  synth::SyntheticFrame scene;
  Frame frame;  ///< without labels
  field::Axes axes;
  path::Region region;
  path::Strands strands;      ///< without a network that links them
  path::Opinion opinion;      ///< what the mask's reading says, where there may be several ropes
  std::vector<int> partners;  ///< [2 * strands] the end that the rope really goes on with from each

  Labelled() = default;
  Labelled(const Labelled&) = delete;
  Labelled& operator=(const Labelled&) = delete;
};

/// Of a scene with dense truth, read as one rope or as if there may be several. Fails as both
/// readings do.
[[nodiscard]] Result<std::unique_ptr<const Labelled>> label(synth::SyntheticFrame scene,
                                                            bool several, field::Network& network);

}  // namespace flowdlo::lab
