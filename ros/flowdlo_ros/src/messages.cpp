#include "messages.hpp"

#include <algorithm>
#include <cstddef>

namespace flowdlo_ros {
namespace {

constexpr double kLineWidth_m = 0.004;
constexpr double kEndDiameter_m = 0.012;

geometry_msgs::Point point_of(const std::array<float, 3>& node) {
  geometry_msgs::Point point;
  point.x = static_cast<double>(node[0]);
  point.y = static_cast<double>(node[1]);
  point.z = static_cast<double>(node[2]);
  return point;
}

visualization_msgs::Marker marker_of(const Rope& rope, const std_msgs::Header& header, int id) {
  visualization_msgs::Marker marker;
  marker.header = header;
  marker.id = id;
  marker.action = visualization_msgs::Marker::ADD;
  marker.pose.orientation.w = 1;
  marker.color.r = 1 - rope.confidence;
  marker.color.g = rope.confidence;
  marker.color.a = 1;
  return marker;
}

}  // namespace

Image image_of(const sensor_msgs::ImageConstPtr& message) {
  if (!message) return {};
  return {message->data.data(), message->data.size(),       message->width,   message->height,
          message->step,        message->is_bigendian != 0, message->encoding};
}

Camera camera_of(const sensor_msgs::CameraInfo& message) {
  Camera camera;
  camera.width = message.width;
  camera.height = message.height;
  std::copy(message.K.begin(), message.K.end(), camera.k.begin());
  std::copy(message.P.begin(), message.P.end(), camera.p.begin());
  camera.d.assign(message.D.begin(), message.D.end());
  return camera;
}

flowdlo_msgs::Ropes ropes_message(const Seen& seen, const std_msgs::Header& header) {
  flowdlo_msgs::Ropes message;
  message.header = header;
  message.total_ms = static_cast<float>(seen.total_ms);
  for (const Rope& rope : seen.ropes) {
    flowdlo_msgs::Rope one;
    one.number = rope.number;
    for (const auto& node : rope.nodes) one.nodes.push_back(point_of(node));
    one.sigma_m = rope.sigma_m;
    one.support.assign(rope.support.begin(), rope.support.end());
    one.confidence = rope.confidence;
    one.source = rope.source;
    one.origin = rope.origin;
    one.doubts = rope.doubts;
    one.closed = rope.closed;
    message.ropes.push_back(one);
  }
  for (const Crossing& crossing : seen.crossings) {
    flowdlo_msgs::Crossing one;
    one.over = crossing.over;
    one.under = crossing.under;
    one.over_at_m = crossing.over_at_m;
    one.under_at_m = crossing.under_at_m;
    one.apart_m = crossing.apart_m;
    message.crossings.push_back(one);
  }
  message.missing = seen.missing;
  return message;
}

nav_msgs::Path path_message(const Rope& rope, const std_msgs::Header& header) {
  nav_msgs::Path path;
  path.header = header;
  for (const auto& node : rope.nodes) {
    geometry_msgs::PoseStamped pose;
    pose.header = header;
    pose.pose.position = point_of(node);
    pose.pose.orientation.w = 1;
    path.poses.push_back(pose);
  }
  return path;
}

visualization_msgs::MarkerArray marker_message(const Seen& seen, const std_msgs::Header& header) {
  visualization_msgs::MarkerArray markers;
  visualization_msgs::Marker clear;  // what an earlier frame with more ropes left
  clear.header = header;
  clear.action = visualization_msgs::Marker::DELETEALL;
  markers.markers.push_back(clear);
  for (std::size_t i = 0; i < seen.ropes.size(); ++i) {
    const Rope& rope = seen.ropes[i];
    auto line = marker_of(rope, header, static_cast<int>(i));
    line.ns = "rope";
    line.type = visualization_msgs::Marker::LINE_STRIP;
    line.scale.x = kLineWidth_m;
    for (const auto& node : rope.nodes) line.points.push_back(point_of(node));
    if (rope.closed) line.points.push_back(line.points.front());
    markers.markers.push_back(line);
    auto first = marker_of(rope, header, static_cast<int>(i));
    first.ns = "node_0";
    first.type = visualization_msgs::Marker::SPHERE;
    first.scale.x = first.scale.y = first.scale.z = kEndDiameter_m;
    first.pose.position = point_of(rope.nodes.front());
    markers.markers.push_back(first);
  }
  return markers;
}

}  // namespace flowdlo_ros
