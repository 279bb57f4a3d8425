// Noise: smooth noise over an image, a sensor's, and a camera's whose pixels are coarser than the
// image's.
#pragma once

#include <opencv2/core.hpp>

#include "strand/dice.hpp"

namespace flowdlo::strand {

/// [size, size] f32 of deviation about 1, smooth over `cell_px`.
[[nodiscard]] cv::Mat smooth_noise(int size_px, double cell_px, Dice& dice);

/// Each pixel its own.
void add_noise(cv::Mat& image, float deviation, Dice& dice);

/// Noise of a camera whose pixels are `pixel_px` wide here, in levels of 255.
void add_camera_noise(cv::Mat& image, float levels, float pixel_px, Dice& dice);

}  // namespace flowdlo::strand
