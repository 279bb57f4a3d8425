#include "rope_choices.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <tuple>

namespace flowdlo_ros {
namespace {

/// A list as its values one after the other, any other parameter as it is written.
std::string text_of(XmlRpc::XmlRpcValue& value) {
  if (value.getType() == XmlRpc::XmlRpcValue::TypeString) return static_cast<std::string>(value);
  std::ostringstream text;
  if (value.getType() != XmlRpc::XmlRpcValue::TypeArray) {
    value.write(text);
    return text.str();
  }
  for (int i = 0; i < value.size(); ++i) {
    if (i > 0) text << ' ';
    value[i].write(text);
  }
  return text.str();
}

auto values_of(const RopesConfig& config) {
  return std::tie(config.rectified, config.keep_order, config.table, config.rope_color,
                  config.color_tolerance);
}

/// `config` with what the parameter server has; a parameter of another type changes nothing.
RopesConfig with_parameters(const ros::NodeHandle& own, RopesConfig config) {
  const auto flag = [&](const char* name, bool& value) { own.getParamCached(name, value); };
  bool rectified = config.rectified;
  bool keep_order = config.keep_order;
  bool table = config.table;
  flag("rectified", rectified);
  flag("keep_order", keep_order);
  flag("table", table);
  config.rectified = rectified;
  config.keep_order = keep_order;
  config.table = table;
  own.getParamCached("color_tolerance", config.color_tolerance);
  config.color_tolerance = std::clamp(config.color_tolerance, 0.0, 1.0);
  XmlRpc::XmlRpcValue color;
  if (own.getParamCached("rope_color", color)) config.rope_color = text_of(color);
  return config;
}

}  // namespace

std::vector<int> color_of(const std::string& text) {
  std::string numbers = text;
  for (const char between : {'[', ']', ','}) {
    std::replace(numbers.begin(), numbers.end(), between, ' ');
  }
  std::istringstream words(numbers);
  std::vector<int> color;
  for (int value = 0; words >> value;) color.push_back(value);
  const bool whole = words.eof();
  const bool fits =
      std::all_of(color.begin(), color.end(), [](int v) { return v >= 0 && v <= 255; });
  if (!whole || !fits || (!color.empty() && color.size() != 3)) {
    throw std::invalid_argument(
        "~rope_color: expected red, green and blue from 0 to 255, as [200, 30, 40], got \"" + text +
        "\"");
  }
  return color;
}

RopeChoices::RopeChoices(const ros::NodeHandle& own)
    : own_(own), config_(RopesConfig::__getDefault__()) {
  config_ = with_parameters(own_, config_);
  static_cast<void>(color_of(config_.rope_color));  // throws where it is none
  own_.setParam("rope_color", config_.rope_color);  // the server reads texts only
  server_ = std::make_unique<dynamic_reconfigure::Server<RopesConfig>>(mutex_, own_);
  server_->setCallback([this](RopesConfig& asked, std::uint32_t /*level*/) { take(asked); });
}

void RopeChoices::take(RopesConfig& asked) {
  try {
    static_cast<void>(color_of(asked.rope_color));
  } catch (const std::invalid_argument& fault) {
    ROS_ERROR("%s; what it was stays", fault.what());
    asked.rope_color = config_.rope_color;
  }
  config_ = asked;
}

Choices RopeChoices::now() {
  const boost::recursive_mutex::scoped_lock lock(mutex_);
  RopesConfig asked = with_parameters(own_, config_);
  if (values_of(asked) != values_of(config_)) {
    take(asked);
    server_->updateConfig(config_);
  }
  return {config_.rectified, config_.keep_order, config_.table, color_of(config_.rope_color),
          config_.color_tolerance};
}

}  // namespace flowdlo_ros
