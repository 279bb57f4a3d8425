// Parted: the ropes of a frame told apart, and which pixel of the mask is whose.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "estimator/rope_readings.hpp"
#include "flowdlo/estimate.hpp"
#include "flowdlo/frame.hpp"
#include "flowdlo/result.hpp"
#include "path/path.hpp"

namespace flowdlo::estimator {

/// The ropes of a frame told apart.
struct Parted {
  path::RopePaths paths;
  std::vector<Witness> witness;  ///< [ropes]
  /// [ropes] width of each, pixels, as its own part of the mask has it.
  std::vector<float> width_px;
  /// [height, width] the rope that a pixel shows, from 1; 0: none.
  std::vector<std::uint16_t> instances;
  std::optional<field::FieldView> seen{};  ///< what a strand field shows, where it told them apart
};

/// With labels in the frame each that covers more than a speck of the mask is one rope; otherwise
/// the mask is read as `ropes` of them, 0: as many as it shows. Where two cross, the pixels are
/// given to the one that is nearer beside the crossing. `see` may show the strand field
/// (`read_ropes`); null: the mask alone is read. `before` as there. Expects a valid frame. Fails as
/// path::trace_ropes does.
[[nodiscard]] Result<Parted> part_ropes(const Frame& frame, int ropes, const SeeAxes& see = {},
                                        const std::vector<path::Path>& before = {});

/// Ropes::instances of a frame that is one rope.
[[nodiscard]] std::vector<std::uint16_t> one_instance(const Frame& frame);

/// Puts the longest of `ropes` first; returns `instances` with the numbers that they have then.
[[nodiscard]] std::vector<std::uint16_t> sort_longest_first(std::vector<std::uint16_t> instances,
                                                            std::vector<Estimate>& ropes);

}  // namespace flowdlo::estimator
