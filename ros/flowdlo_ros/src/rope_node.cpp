#include "rope_node.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace flowdlo_ros {
namespace {

Setup setup_of(const ros::NodeHandle& own) {
  Setup setup;
  own.getParam("weights", setup.weights);
  own.getParam("device", setup.device);
  own.getParam("quality", setup.quality);
  own.getParam("ropes", setup.ropes);
  own.getParam("threads", setup.threads);
  own.getParam("rope_length_m", setup.rope_length_m);
  own.getParam("ring", setup.ring);
  own.getParam("budget_ms", setup.budget_ms);
  own.getParam("most_moved_m", setup.most_moved_m);
  own.getParam("patience", setup.patience);
  setup.seed = static_cast<std::uint64_t>(std::max(0, own.param("seed", 0)));
  return setup;
}

}  // namespace

RopeNode::RopeNode(const ros::NodeHandle& topics, const ros::NodeHandle& own,
                   const std::string& name)
    : topics_(topics), own_(own), choices_(own), diagnostics_(topics, own, name) {
  std::string error;
  core_ = std::make_unique<RopeCore>(setup_of(own_), error);
  if (!error.empty()) throw std::runtime_error(error);
  with_mask_ = own_.param("use_mask", true);
  with_color_ = own_.param("use_color", !with_mask_);
  if (!with_mask_ && !with_color_) {
    throw std::runtime_error("expected ~use_mask or ~use_color, got neither");
  }
  ropes_ = own_.advertise<flowdlo_msgs::Ropes>("ropes", 1);
  markers_ = own_.advertise<visualization_msgs::MarkerArray>("markers", 1);
  path_ = own_.advertise<nav_msgs::Path>("path", 1);
  reset_ = own_.advertiseService("reset", &RopeNode::reset, this);
  set_end_ = own_.advertiseService("set_end", &RopeNode::set_end, this);

  least_hz_ = own_.param("least_hz", 0.0);
  most_hz_ = own_.param("most_hz", std::numeric_limits<double>::infinity());
  diagnostics_.setHardwareID("none");
  diagnostics_.add("estimate", this, &RopeNode::describe);
  rate_ = std::make_unique<diagnostic_updater::HeaderlessTopicDiagnostic>(
      "ropes", diagnostics_, diagnostic_updater::FrequencyStatusParam(&least_hz_, &most_hz_));
  ticks_ = own_.createTimer(ros::Duration(1), [this](const ros::TimerEvent&) {
    static_cast<void>(choices_.now());  // without frames, too, windows show what rosparam has set
    diagnostics_.update();
  });
  subscribe();
}

void RopeNode::subscribe() {
  constexpr std::uint32_t kQueue = 5;
  const auto within = ros::Duration(own_.param("sync_tolerance_s", 0.02));
  depth_.subscribe(topics_, "depth", kQueue);
  info_.subscribe(topics_, "camera_info", kQueue);
  if (with_mask_) mask_.subscribe(topics_, "mask", kQueue);
  if (with_color_) color_.subscribe(topics_, "color", kQueue);
  // With a least time between messages of a topic a set is complete when its last one comes;
  // without one the next frame would have to come first.
  const auto apart = ros::Duration(own_.param("least_interval_s", 0.02));
  const auto tune = [&](auto& policy, int topics) {
    policy.setMaxIntervalDuration(within);
    for (int i = 0; i < topics; ++i) policy.setInterMessageLowerBound(i, apart);
  };
  using sensor_msgs::CameraInfo;
  using ImageMessage = sensor_msgs::Image;
  if (with_mask_ && with_color_) {
    using All = Near<ImageMessage, ImageMessage, ImageMessage, CameraInfo>;
    auto all = std::make_shared<message_filters::Synchronizer<All>>(All(kQueue), depth_, mask_,
                                                                    color_, info_);
    tune(*all->getPolicy(), 4);
    all->registerCallback(&RopeNode::see, this);
    synchronizer_ = all;
    return;
  }
  using Two = Near<ImageMessage, ImageMessage, CameraInfo>;
  auto& other = with_mask_ ? mask_ : color_;
  auto two =
      std::make_shared<message_filters::Synchronizer<Two>>(Two(kQueue), depth_, other, info_);
  tune(*two->getPolicy(), 3);
  two->registerCallback(&RopeNode::see_one_of_two, this);
  synchronizer_ = two;
}

void RopeNode::see(const Depth& depth, const sensor_msgs::ImageConstPtr& mask,
                   const sensor_msgs::ImageConstPtr& color, const Info& info) {
  const Seen seen = core_->see(image_of(depth), image_of(mask), image_of(color), camera_of(*info),
                               choices_.now());
  last_error_ = seen.error;
  if (!seen.error.empty()) {
    ROS_WARN_THROTTLE(5, "no ropes: %s", seen.error.c_str());
    return;
  }
  last_ms_ = seen.total_ms;
  last_confidence_ = 1;
  for (const Rope& rope : seen.ropes) {
    last_confidence_ = std::min(last_confidence_, rope.confidence);
  }
  ropes_.publish(ropes_message(seen, depth->header));
  markers_.publish(marker_message(seen, depth->header));
  path_.publish(path_message(seen.ropes.front(), depth->header));
  rate_->tick();
}

void RopeNode::see_one_of_two(const Depth& depth, const sensor_msgs::ImageConstPtr& image,
                              const Info& info) {
  const sensor_msgs::ImageConstPtr none;
  see(depth, with_mask_ ? image : none, with_mask_ ? none : image, info);
}

bool RopeNode::reset(std_srvs::Trigger::Request& /*request*/,
                     std_srvs::Trigger::Response& response) {
  core_->reset();
  response.success = 1;
  return true;
}

bool RopeNode::set_end(flowdlo_msgs::SetEnd::Request& request,
                       flowdlo_msgs::SetEnd::Response& response) {
  core_->set_end(request.u, request.v);
  response.success = 1;
  return true;
}

void RopeNode::describe(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  if (last_error_.empty()) {
    status.summary(DiagnosticStatus::OK, "ropes are seen");
  } else {
    status.summary(DiagnosticStatus::WARN, last_error_);
  }
  status.add("milliseconds a frame", last_ms_);
  status.add("least confidence", last_confidence_);
}

}  // namespace flowdlo_ros
