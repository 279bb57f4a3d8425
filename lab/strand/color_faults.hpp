// Color faults: other ropes, other grounds, other light and other cameras for the same patch.
#pragma once

#include <opencv2/core.hpp>

#include "strand/dice.hpp"
#include "strand/sample.hpp"
#include "strand/targets.hpp"

namespace flowdlo::strand {

/// `color` is f32, 0 to 1, three channels; `pixel_px`: the camera's pixel in pixels of the sample.
void spoil_colors(const Targets& truth, const SpoilConfig& config, float pixel_px, Dice& dice,
                  cv::Mat& color);

}  // namespace flowdlo::strand
