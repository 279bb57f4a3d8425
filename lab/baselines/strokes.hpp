// Strokes: a skeleton cut at its junctions into ordered runs of pixels.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace flowdlo::baselines {

using Stroke = std::vector<cv::Point2f>;  ///< ordered, pixels

/// Pixels of `skeleton` (u8, set where not 0) with more than two neighbours in 3 x 3: u8, 0 or 255.
[[nodiscard]] cv::Mat junction_pixels(const cv::Mat& skeleton);

/// The runs that are left when `junctions` are deleted, each from one end to the other; a ring is
/// cut at its first pixel. Row-major order of their first pixels; single pixels count.
[[nodiscard]] std::vector<Stroke> strokes_of(const cv::Mat& skeleton, const cv::Mat& junctions);

[[nodiscard]] double length_px(const Stroke& stroke);

/// Unit vector in which `stroke` leaves over its last point (its first, where not `end`): the
/// chord over `span_px`, begun `skip_px` before that end, as far as the stroke is that long.
[[nodiscard]] cv::Point2f direction_out(const Stroke& stroke, bool end, double skip_px,
                                        double span_px);

}  // namespace flowdlo::baselines
