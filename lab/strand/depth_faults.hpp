// Depth faults: what depth sensors, and those who cut the rope out first, do to a depth image.
#pragma once

#include <opencv2/core.hpp>

#include "strand/dice.hpp"

namespace flowdlo::strand {

/// Thin things sunk into what is behind, noise, an offset, steps and holes. `depth` is f32, metres,
/// 0: unknown.
void spoil_depth(float focal_px, Dice& dice, cv::Mat& depth);

/// As those have it who cut the rope out first: no depth around it, and often a ribbon's. `mask` is
/// f32, 0 to 1.
void keep_depth_of_mask(const cv::Mat& mask, Dice& dice, cv::Mat& depth);

}  // namespace flowdlo::strand
