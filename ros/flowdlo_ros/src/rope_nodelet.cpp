// RopeNodelet: the node within a nodelet manager, where images come as pointers.
#include <nodelet/nodelet.h>
#include <pluginlib/class_list_macros.hpp>

#include <exception>
#include <memory>

#include "rope_node.hpp"

namespace flowdlo_ros {

class RopeNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    try {
      node_ = std::make_unique<RopeNode>(getNodeHandle(), getPrivateNodeHandle(), getName());
    } catch (const std::exception& fault) {
      NODELET_FATAL("%s", fault.what());
      throw;
    }
  }

  std::unique_ptr<RopeNode> node_;
};

}  // namespace flowdlo_ros

PLUGINLIB_EXPORT_CLASS(flowdlo_ros::RopeNodelet, nodelet::Nodelet)
