// Chains: the skeleton as runs of straight pieces, field section 1, points 5 and 6.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "flowdlo/result.hpp"

namespace flowdlo::baselines {

using Chain = std::vector<cv::Point>;

struct ChainConfig {
  double segment_px = 8;
  double max_turn_deg = 25;
  double segment_width_px = 3;  ///< of the rectangles that prune
};

/// Chains of the contours of `skeleton` (u8, 0 or 255), in contour order: a branch appears once a
/// side. An exactly straight skeleton has none, as its contour has two vertices.
[[nodiscard]] std::vector<Chain> chains_of(const cv::Mat& skeleton, const ChainConfig& config = {});

/// What is left when each chain, longest first, deletes the segments of the others that cross its
/// own; the rest of such a chain stays in one piece. A segment that bridges a deleted middle was
/// never given a rectangle: where one is asked for, fails with kInternal, unless `repaired`.
[[nodiscard]] Result<std::vector<Chain>> pruned(std::vector<Chain> chains, bool repaired,
                                                const ChainConfig& config = {});

}  // namespace flowdlo::baselines
