// RopeChoices: what may change while the node runs, by dynamic_reconfigure or by rosparam.
#pragma once

#include <dynamic_reconfigure/server.h>
#include <flowdlo_ros/RopesConfig.h>
#include <ros/ros.h>

#include <boost/thread/recursive_mutex.hpp>
#include <memory>
#include <string>
#include <vector>

#include "rope_core.hpp"

namespace flowdlo_ros {

class RopeChoices {
 public:
  /// Begins with what the parameters below `own` say.
  explicit RopeChoices(const ros::NodeHandle& own);

  /// What holds for the next frame. What rosparam has set since the last call is taken over, and
  /// the windows of dynamic_reconfigure are told.
  [[nodiscard]] Choices now();

 private:
  void take(RopesConfig& asked);

  ros::NodeHandle own_;
  RopesConfig config_;
  boost::recursive_mutex mutex_;
  std::unique_ptr<dynamic_reconfigure::Server<RopesConfig>> server_;
};

/// Red, green, blue, 0..255 each, of "[200, 30, 40]" or "200 30 40"; none of an empty text. Throws
/// std::invalid_argument, which says what was expected, for any other.
[[nodiscard]] std::vector<int> color_of(const std::string& text);

}  // namespace flowdlo_ros
