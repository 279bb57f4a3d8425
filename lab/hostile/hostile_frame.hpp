// A frame around a mask: a tilted, noisy depth with holes, as sensors give it.
#pragma once

#include <opencv2/core.hpp>
#include <string>

#include "flowdlo/frame_folder.hpp"

namespace flowdlo::lab {

/// `mask` is [h, w] u8. What it holds lies 3 cm above a plane that is tilted and half a metre away;
/// depths are off by up to a millimetre, and one in 32 is missing. The same for the same mask.
[[nodiscard]] FrameFolder frame_around(const cv::Mat& mask, std::string name);

}  // namespace flowdlo::lab
