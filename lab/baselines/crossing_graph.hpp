// CrossingGraph: strokes and the crossings at which they meet, spurs removed, pairs of flat Y
// junctions made one X. The skeleton as mBEST reads it.
#pragma once

#include <vector>

#include "baselines/strokes.hpp"

namespace flowdlo::baselines {

/// Stroke ends are numbered 2 * stroke, + 1 at the last point.
struct CrossingGraph {
  std::vector<Stroke> strokes;      ///< some empty: removed or joined to others
  std::vector<int> crossing_of;     ///< by stroke end; -1: a free end
  std::vector<cv::Point2f> places;  ///< by crossing
  double radius_px = 0;             ///< largest distance to the mask's border on the skeleton

  [[nodiscard]] std::vector<int> ends_at(int crossing) const;
};

[[nodiscard]] CrossingGraph crossing_graph(const cv::Mat& mask);

}  // namespace flowdlo::baselines
