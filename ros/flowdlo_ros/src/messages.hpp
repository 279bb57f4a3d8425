// Messages: ropes as ROS 1 publishes them.
#pragma once

#include <flowdlo_msgs/Ropes.h>
#include <nav_msgs/Path.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/Image.h>
#include <std_msgs/Header.h>
#include <visualization_msgs/MarkerArray.h>

#include "rope_core.hpp"

namespace flowdlo_ros {

/// Views into the message, which lives as long as they are used; none of a null pointer.
Image image_of(const sensor_msgs::ImageConstPtr& message);
Camera camera_of(const sensor_msgs::CameraInfo& message);

/// All of them keep `header`, the depth image's: nodes are in its frame and of its time.
flowdlo_msgs::Ropes ropes_message(const Seen& seen, const std_msgs::Header& header);
nav_msgs::Path path_message(const Rope& rope, const std_msgs::Header& header);
/// A line for each rope, red where confidence is 0 and green where it is 1, and a ball at node 0.
visualization_msgs::MarkerArray marker_message(const Seen& seen, const std_msgs::Header& header);

}  // namespace flowdlo_ros
