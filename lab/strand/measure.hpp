// Measure: how many places of the strands that show a field finds, and how many of those it shows
// are there.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "field/region.hpp"
#include "field/ridge.hpp"
#include "strand/patch.hpp"

namespace flowdlo::strand {

/// A place is found by an axis point within a quarter of a width and 20 degrees; an axis point is
/// right within a quarter of a width, or a pixel of the region, of a strand's axis.
struct Counts {
  long places = 0;  ///< of strands, that show and are on the mask, or a pixel or two beside it
  long found = 0;
  long merged_places = 0;  ///< of those within 1.5 widths of another strand
  long merged_found = 0;
  long shown = 0;  ///< axis points
  long right = 0;
  long merged_shown = 0;  ///< whose nearest place is merged
  long merged_right = 0;
  long ends = 0;        ///< that show
  long ends_found = 0;  ///< by a tip within a width
  long tips = 0;
  long tips_right = 0;
  long crossings = 0;        ///< where one strand passes over another
  long crossings_right = 0;  ///< where the field's direction is that of the upper one

  Counts& operator+=(const Counts& other);
};

/// What is found of strands in pixels of the region. `mask` is the region's, f32.
[[nodiscard]] Counts measure(const std::vector<Strand>& strands, const cv::Mat& mask,
                             const std::vector<field::RidgePoint>& ridge,
                             const std::vector<Eigen::Vector2f>& tips);

/// Tips and ends by how clearly they show, for any least kTip.
struct TipLevels {
  struct Tip {
    Eigen::Vector2f px;  ///< of the region
    float level = 0;     ///< kTip there
    bool right = false;
  };
  std::vector<Tip> tips;
  std::vector<float> ends;  ///< kTip of the clearest tip within a width of each end; 0: none

  TipLevels& operator+=(const TipLevels& other);
};

/// Of a field [height, width, field::kChannels] all tips of kTip `least` and more.
[[nodiscard]] TipLevels tip_levels(const std::vector<Strand>& strands, const field::Channels& field,
                                   float least);

/// Adds crossings to `counts`: of strands in the region against the field's direction there.
void measure_crossings(const std::vector<Strand>& strands, const cv::Mat& field, Counts& counts);

/// Strands of a frame in pixels of a region of it.
[[nodiscard]] std::vector<Strand> in_region(const std::vector<Strand>& strands,
                                            const field::Region& region);

/// What thinning of the mask gives in place of a field.
[[nodiscard]] std::vector<field::RidgePoint> thinned(const cv::Mat& mask);

}  // namespace flowdlo::strand
