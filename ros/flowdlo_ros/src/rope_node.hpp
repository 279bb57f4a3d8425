// RopeNode: topics in, ropes out.
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <diagnostic_updater/publisher.h>
#include <flowdlo_msgs/SetEnd.h>
#include <message_filters/subscriber.h>
#include <message_filters/sync_policies/approximate_time.h>
#include <message_filters/synchronizer.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>

#include <memory>
#include <string>

#include "messages.hpp"
#include "rope_choices.hpp"

namespace flowdlo_ros {

class RopeNode {
 public:
  /// Reads its parameters below `own`. `name` is what diagnostics call it. Throws
  /// std::runtime_error or std::invalid_argument where no estimator can be made of them.
  RopeNode(const ros::NodeHandle& topics, const ros::NodeHandle& own, const std::string& name);

 private:
  using Depth = sensor_msgs::ImageConstPtr;
  using Info = sensor_msgs::CameraInfoConstPtr;
  template <class... Messages>
  using Near = message_filters::sync_policies::ApproximateTime<Messages...>;

  void subscribe();
  void see(const Depth& depth, const sensor_msgs::ImageConstPtr& mask,
           const sensor_msgs::ImageConstPtr& color, const Info& info);
  /// The image is the mask where there is one, otherwise the colour.
  void see_one_of_two(const Depth& depth, const sensor_msgs::ImageConstPtr& image,
                      const Info& info);
  bool reset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool set_end(flowdlo_msgs::SetEnd::Request& request, flowdlo_msgs::SetEnd::Response& response);
  void describe(diagnostic_updater::DiagnosticStatusWrapper& status);

  ros::NodeHandle topics_;
  ros::NodeHandle own_;
  std::unique_ptr<RopeCore> core_;
  RopeChoices choices_;
  bool with_mask_ = true;
  bool with_color_ = false;

  message_filters::Subscriber<sensor_msgs::Image> depth_;
  message_filters::Subscriber<sensor_msgs::Image> mask_;
  message_filters::Subscriber<sensor_msgs::Image> color_;
  message_filters::Subscriber<sensor_msgs::CameraInfo> info_;
  std::shared_ptr<void> synchronizer_;

  ros::Publisher ropes_;
  ros::Publisher markers_;
  ros::Publisher path_;
  ros::ServiceServer reset_;
  ros::ServiceServer set_end_;

  double least_hz_ = 0;
  double most_hz_ = 0;
  diagnostic_updater::Updater diagnostics_;
  std::unique_ptr<diagnostic_updater::HeaderlessTopicDiagnostic> rate_;
  ros::Timer ticks_;
  std::string last_error_ = "no frame yet";
  double last_ms_ = 0;
  float last_confidence_ = 0;
};

}  // namespace flowdlo_ros
