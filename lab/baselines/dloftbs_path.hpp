// DLOFTBs-like path (ICRA 2023): skeleton segments linked tip to tip, then a B-spline.
#pragma once

#include "baselines/strokes.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::baselines {

/// Junction pixels are deleted, segments under 10 px dropped, tips linked greedily, the cheapest
/// first, never closing a loop; gaps are bridged so. A cubic B-spline an axis, sampled a pixel
/// apart. `mask` is [h, w] u8, set where not 0. Fails with kNoPath without a segment.
[[nodiscard]] Result<Stroke> dloftbs_path(const cv::Mat& mask);

}  // namespace flowdlo::baselines
