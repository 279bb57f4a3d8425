// Mask faults: what segmentations do to a mask.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "strand/dice.hpp"
#include "strand/patch.hpp"

namespace flowdlo::strand {

/// Grown, eroded, closed, moved, frayed, in specks, or without tips and stretches of strands.
/// Returns what was taken off strands; empty: nothing. `mask` is f32, 0 to 1.
[[nodiscard]] cv::Mat spoil_mask(const std::vector<Strand>& strands, Dice& dice, cv::Mat& mask);

}  // namespace flowdlo::strand
