// Strip: the rope straightened, cross-sections of mask and depth along the path.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "evidence/visible_points.hpp"
#include "flowdlo/frame.hpp"

namespace flowdlo::prior {

/// A place on the path with the mask beside it.
struct Station {
  Eigen::Vector2f point_px{0, 0};
  Eigen::Vector2f normal{0, 1};  ///< unit, across the path
  float arclength_px = 0;
  Eigen::Vector3f ray{0, 0, 1};  ///< the point at z = 1 m; times a depth it is a point
  float aside = 0;               ///< metres across the ray for 1 px of offset at 1 m of depth
  float left_px = 0;             ///< how far the mask reaches along -normal,
  float right_px = 0;            ///< and along +normal
  float beside_m = 0;            ///< depth beyond the mask's edges, the deeper side's; 0: none
  float ground_m = 0;            ///< depth under the axis of what is on both sides of the rope,
                                 ///< clear of the mask by what a camera mixes; 0: unknown
  Eigen::Vector3f ground_across{0, 0, 0};  ///< metres, from one side of it to the other
  bool masked = false;           ///< the path runs over the mask here
  bool bounded = false;          ///< the mask ends on both sides within reach
};

/// A mask pixel with a depth, beside a station. Stations near a crossing share pixels with those
/// of another strand, the rival.
struct Reading {
  int station = 0;
  float offset_px = 0;  ///< along the normal
  float depth_m = 0;
  int rival = -1;  ///< nearest station of another strand that covers the pixel, -1: none
  float rival_offset_px = 0;
};

struct Strip {
  std::vector<Station> stations;  ///< evenly spaced, at least two
  std::vector<Reading> readings;  ///< in the order of stations
  std::vector<int> neighbour;     ///< [stations] nearest station of another strand, -1: none near
  float step_px = 1;              ///< from station to station
  float width_px = 1;             ///< of the rope in the mask
};

/// `path_px` has at least two finite points, `width_px` is at least 1, `cloud` is the frame's.
/// Cross-sections reach half a width to both sides and read pixels spaced by the width; of a sparse
/// cloud every pixel is read.
[[nodiscard]] Strip make_strip(std::span<const Eigen::Vector2f> path_px, float width_px,
                               const Frame& frame, const evidence::Cloud& cloud);

}  // namespace flowdlo::prior
