// Targets: strands to the field that a perfect network would see.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "strand/patch.hpp"

namespace flowdlo::strand {

struct Targets {
  cv::Mat field;  ///< [height, width, field::kChannels] f32
  cv::Mat along;  ///< f32: where along its rope the strand lies that shows, in its widths
  cv::Mat off;    ///< f32: how far off its axis, in its radii, left of its way above 0; 9: no rope
};

/// Strands in pixels of an image of that size, seen with fx = `focal_px`.
[[nodiscard]] Targets targets_of(const std::vector<Strand>& strands, float focal_px,
                                 const cv::Size& size);

/// The ends that show, pixels.
[[nodiscard]] std::vector<cv::Point2f> visible_tips(const std::vector<Strand>& strands);

}  // namespace flowdlo::strand
