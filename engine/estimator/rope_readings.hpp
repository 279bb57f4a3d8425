// RopeReadings: the ropes of a frame as paths, from the strand field where it is asked and from the
// mask alone where it is not; and which of them both looks have.
#pragma once

#include <optional>
#include <vector>

#include "estimator/rope_confidence.hpp"
#include "estimator/see_axes.hpp"
#include "flowdlo/frame.hpp"
#include "flowdlo/result.hpp"
#include "path/path.hpp"

namespace flowdlo::estimator {

/// The ropes of a frame before pixels are given to them.
struct RopeReadings {
  path::RopePaths paths;
  std::vector<Witness> witness;            ///< [ropes]
  std::optional<field::FieldView> seen{};  ///< what the field shows, where the paths are of it
};

/// Those of the axes that `see` shows, for strands that the mask merges lie apart there: by heed of
/// the mask's reading, whose ropes are their witness. Where one of them is not told apart surely,
/// by heed of a closer look (kCloser), if there is one (field::looks_closer), as well, either's
/// opinion by half. The mask's
/// (`path::trace_ropes`) where it is noise, or `see` shows nothing or no ropes. `before` as there.
/// Expects a valid frame. Fails as path::trace_ropes does of the mask.
[[nodiscard]] Result<RopeReadings> read_ropes(const Frame& frame, int ropes, const SeeAxes& see,
                                              const std::vector<path::Path>& before = {});

}  // namespace flowdlo::estimator
