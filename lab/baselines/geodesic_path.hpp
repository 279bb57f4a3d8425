// Geodesic path: the shortest way along the skeleton between its two farthest pixels, as in
// AssistDLO's trace (there on a Voronoi graph). It takes the short cut at every crossing.
#pragma once

#include "baselines/strokes.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::baselines {

/// Of the component with the longest such way. `mask` is [h, w] u8, set where not 0. Fails with
/// kNoPath where the mask holds no line of two pixels.
[[nodiscard]] Result<Stroke> geodesic_path(const cv::Mat& mask);

}  // namespace flowdlo::baselines
