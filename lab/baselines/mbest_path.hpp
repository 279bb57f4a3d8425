// mBEST-like path (RA-L 2023): crossings of the skeleton passed with minimal bending energy.
#pragma once

#include "baselines/strokes.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::baselines {

/// The longest walk from an end of the skeleton to another. `mask` is [h, w] u8, set where not 0.
/// Fails with kNoPath where there is no line, no end (a closed loop), or a crossing of more than
/// four branches. Gaps are not bridged: of a mask in pieces one piece is returned.
[[nodiscard]] Result<Stroke> mbest_path(const cv::Mat& mask);

}  // namespace flowdlo::baselines
