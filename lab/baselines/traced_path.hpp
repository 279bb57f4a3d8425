// TracedPath: published ways from a mask to one ordered line, each along its skeleton. `mask` is
// [h, w] u8, set where not 0.
#pragma once

#include <opencv2/core.hpp>

#include "baselines/strokes.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::baselines {

/// The shortest way along the skeleton between its two farthest pixels, of the component with the
/// longest such way, as in AssistDLO's trace (there on a Voronoi graph). It takes the short cut at
/// every crossing. Fails with kNoPath where the mask holds no line of two pixels.
[[nodiscard]] Result<Stroke> geodesic_path(const cv::Mat& mask);

/// As mBEST (RA-L 2023): crossings of the skeleton passed with minimal bending energy; the longest
/// walk from an end to another. Fails with kNoPath where there is no line, no end (a closed loop),
/// or a crossing of more than four branches. Gaps are not bridged: of a mask in pieces one piece is
/// returned.
[[nodiscard]] Result<Stroke> mbest_path(const cv::Mat& mask);

/// As DLOFTBs (ICRA 2023): junction pixels are deleted, segments under 10 px dropped, tips linked
/// greedily, the cheapest first, never closing a loop; gaps are bridged so. A cubic B-spline an
/// axis, sampled a pixel apart. Fails with kNoPath without a segment.
[[nodiscard]] Result<Stroke> dloftbs_path(const cv::Mat& mask);

}  // namespace flowdlo::baselines
