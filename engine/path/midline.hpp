// Midline: pixel chains as smooth lines in the middle of the mask.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "image/image.hpp"

namespace flowdlo::path {

/// Length of a line, pixels.
[[nodiscard]] float length_of(const std::vector<Eigen::Vector2f>& points);

/// Two passes of a running mean over 2 `half` + 1 points, narrower towards the ends, which stay.
[[nodiscard]] std::vector<Eigen::Vector2f> smoothed(std::vector<Eigen::Vector2f> points, int half);

/// Thinning leaves a line a pixel or two off the middle: each point moves to the middle of the
/// mask across the line, where the mask is about `width_px` wide; the moves are smoothed.
void recentre(std::vector<Eigen::Vector2f>& points, const image::Mask& mask, float width_px);

/// Unit direction of the line at its front, pointing off it; fitted over a width and a half.
[[nodiscard]] Eigen::Vector2f direction_at_front(const std::vector<Eigen::Vector2f>& points,
                                                 float scale_px);

/// Curvature (1 / px) of the line at its front, walking off it; positive from x to y. Less than it
/// looks where the line is too short to tell.
[[nodiscard]] float curvature_at_front(const std::vector<Eigen::Vector2f>& points, float scale_px);

}  // namespace flowdlo::path
