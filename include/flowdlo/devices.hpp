// Devices: what this machine offers, what each device lacks, and which one "auto" takes.
#pragma once

#include <string>
#include <vector>

#include "flowdlo/export.hpp"

namespace flowdlo {

enum class DeviceKind { kDiscreteGpu, kIntegratedGpu, kVirtualGpu, kCpu, kOther };

struct DeviceReport {
  std::string name;  ///< as the driver says it
  std::string uuid;  ///< 32 hexadecimal digits
  DeviceKind kind = DeviceKind::kOther;
  std::string driver;       ///< name and version
  std::string api_version;  ///< "1.3.230"
  int subgroup_size = 0;
  std::vector<std::string> lacks;  ///< what FlowDLO needs and the device has not; empty: usable
  bool self_test_run = false;      ///< false: not asked for, or the device lacks something
  bool self_test_passed = false;
  std::string self_test;  ///< verdict in words, with the largest difference seen
};

struct DeviceSurvey {
  std::vector<DeviceReport> vulkan;  ///< in the driver's order
  std::string loader;                ///< version of the Vulkan loader, or "none"
  std::string advice;       ///< where no Vulkan device is usable: why, and what to install for one
  std::string auto_choice;  ///< what Config::device = "auto" takes: a name, or "cpu"
};

/// Looks at every Vulkan device; with `self_test`, runs a known-answer model on each usable one.
/// Never fails: a machine without Vulkan has an empty list, and `advice` says why.
[[nodiscard]] FLOWDLO_EXPORT DeviceSurvey survey_devices(bool self_test);

}  // namespace flowdlo
