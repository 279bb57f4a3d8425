// flowdlo_ros2: the node of ROS 1 over the same core, reduced to the path of the first rope.
#include <message_filters/subscriber.h>
#include <message_filters/sync_policies/approximate_time.h>
#include <message_filters/synchronizer.h>

#include <chrono>
#include <exception>
#include <iostream>
#include <memory>
#include <nav_msgs/msg/path.hpp>
#include <rclcpp/rclcpp.hpp>
#include <sensor_msgs/msg/camera_info.hpp>
#include <sensor_msgs/msg/image.hpp>
#include <std_srvs/srv/trigger.hpp>
#include <stdexcept>
#include <string>

#include "rope_core.hpp"

namespace flowdlo_ros {
namespace {

using ImageMessage = sensor_msgs::msg::Image;
using InfoMessage = sensor_msgs::msg::CameraInfo;

Image image_of(const ImageMessage& message) {
  return {message.data.data(), message.data.size(),       message.width,   message.height,
          message.step,        message.is_bigendian != 0, message.encoding};
}

Camera camera_of(const InfoMessage& message) {
  Camera camera;
  camera.width = message.width;
  camera.height = message.height;
  camera.k = message.k;
  camera.p = message.p;
  camera.d = message.d;
  return camera;
}

class RopeNode : public rclcpp::Node {
 public:
  RopeNode() : rclcpp::Node("flowdlo_ros2") {
    Setup setup;
    setup.weights = declare_parameter("weights", setup.weights);
    setup.device = declare_parameter("device", setup.device);
    setup.quality = declare_parameter("quality", setup.quality);
    setup.rope_length_m = declare_parameter("rope_length_m", setup.rope_length_m);
    setup.ring = declare_parameter("ring", setup.ring);
    setup.budget_ms = declare_parameter("budget_ms", setup.budget_ms);
    choices_.rectified = declare_parameter("rectified", choices_.rectified);
    choices_.keep_order = declare_parameter("keep_order", choices_.keep_order);
    std::string error;
    core_ = std::make_unique<RopeCore>(setup, error);
    if (!error.empty()) throw std::runtime_error(error);
    path_ = create_publisher<nav_msgs::msg::Path>("~/path", 1);
    using std_srvs::srv::Trigger;
    reset_ = create_service<Trigger>(
        "~/reset",
        [this](const Trigger::Request::SharedPtr&, const Trigger::Response::SharedPtr& response) {
          core_->reset();
          response->success = true;
        });
    depth_.subscribe(this, "depth");
    mask_.subscribe(this, "mask");
    info_.subscribe(this, "camera_info");
    synchronizer_ = std::make_unique<Synchronizer>(Policy(5), depth_, mask_, info_);
    synchronizer_->registerCallback(&RopeNode::see, this);
  }

 private:
  using Policy =
      message_filters::sync_policies::ApproximateTime<ImageMessage, ImageMessage, InfoMessage>;
  using Synchronizer = message_filters::Synchronizer<Policy>;

  void see(const ImageMessage::ConstSharedPtr& depth, const ImageMessage::ConstSharedPtr& mask,
           const InfoMessage::ConstSharedPtr& info) {
    const Seen seen = core_->see(image_of(*depth), image_of(*mask), {}, camera_of(*info), choices_);
    if (!seen.error.empty()) {
      RCLCPP_WARN(get_logger(), "no ropes: %s", seen.error.c_str());
      return;
    }
    nav_msgs::msg::Path path;
    path.header = depth->header;
    for (const auto& node : seen.ropes.front().nodes) {
      geometry_msgs::msg::PoseStamped pose;
      pose.header = depth->header;
      pose.pose.position.x = static_cast<double>(node[0]);
      pose.pose.position.y = static_cast<double>(node[1]);
      pose.pose.position.z = static_cast<double>(node[2]);
      pose.pose.orientation.w = 1;
      path.poses.push_back(pose);
    }
    path_->publish(path);
  }

  Choices choices_;
  std::unique_ptr<RopeCore> core_;
  message_filters::Subscriber<ImageMessage> depth_;
  message_filters::Subscriber<ImageMessage> mask_;
  message_filters::Subscriber<InfoMessage> info_;
  std::unique_ptr<Synchronizer> synchronizer_;
  rclcpp::Publisher<nav_msgs::msg::Path>::SharedPtr path_;
  rclcpp::Service<std_srvs::srv::Trigger>::SharedPtr reset_;
};

}  // namespace
}  // namespace flowdlo_ros

int main(int argc, char** argv) {
  rclcpp::init(argc, argv);
  try {
    rclcpp::spin(std::make_shared<flowdlo_ros::RopeNode>());
  } catch (const std::exception& fault) {
    std::cerr << "flowdlo_ros2: " << fault.what() << '\n';
    return 1;
  }
  rclcpp::shutdown();
  return 0;
}
