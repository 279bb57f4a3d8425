// flowdlo_ros: the node. docs/ros.md has its topics, parameters and services.
#include <ros/ros.h>

#include <exception>
#include <iostream>

#include "rope_node.hpp"

int main(int argc, char** argv) {
  ros::init(argc, argv, "flowdlo_ros");
  try {
    const flowdlo_ros::RopeNode node({}, ros::NodeHandle("~"), ros::this_node::getName());
    ros::spin();
  } catch (const std::exception& fault) {
    std::cerr << "flowdlo_ros: " << fault.what() << '\n';
    return 1;
  }
  return 0;
}
