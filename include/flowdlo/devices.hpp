// Devices: what this machine offers, what each device lacks, and which one "auto" takes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "flowdlo/export.hpp"

namespace flowdlo {

enum class DeviceKind { kDiscreteGpu, kIntegratedGpu, kVirtualGpu, kCpu, kOther };

/// "discrete_gpu", "integrated_gpu", "virtual_gpu", "cpu" (a driver that runs on the CPU) or
/// "other".
[[nodiscard]] constexpr const char* name_of(DeviceKind kind) {
  switch (kind) {
    case DeviceKind::kDiscreteGpu:
      return "discrete_gpu";
    case DeviceKind::kIntegratedGpu:
      return "integrated_gpu";
    case DeviceKind::kVirtualGpu:
      return "virtual_gpu";
    case DeviceKind::kCpu:
      return "cpu";
    case DeviceKind::kOther:
      break;
  }
  return "other";
}

struct DeviceReport {
  std::string name;  ///< as the driver says it
  std::string uuid;  ///< 32 hexadecimal digits
  DeviceKind kind = DeviceKind::kOther;
  std::string driver;       ///< name and version
  std::string api_version;  ///< "1.3.230"
  int subgroup_size = 0;
  bool shuffles = true;            ///< false: kernels run that need none
  std::vector<std::string> lacks;  ///< what FlowDLO needs and the device has not; empty: usable
  bool self_test_run = false;      ///< false: not asked for, or the device lacks something
  bool self_test_passed = false;
  std::string self_test;  ///< verdict in words, with the largest difference seen
};

/// One Vulkan driver, as it behaved when it was asked in a process of its own.
struct DriverReport {
  std::filesystem::path manifest;  ///< the JSON file by which the loader finds it
  bool used = true;                ///< false: it crashed or hung there, and is never loaded here
  int devices = 0;                 ///< that it listed there
  std::string verdict;             ///< in words; what it did, and where
  bool remembered = false;         ///< asked by an earlier process
};

struct DeviceSurvey {
  std::vector<DriverReport> drivers;  ///< in the loader's order
  /// Why drivers were loaded without having been asked before; empty: they were asked.
  std::string unseen;
  std::vector<DeviceReport> vulkan;  ///< in the drivers' order
  std::string loader;                ///< version of the Vulkan loader, or "none"
  std::string advice;       ///< where no Vulkan device is usable: why, and what to install for one
  std::string auto_choice;  ///< what Config::device = "auto" takes: a name, or "cpu"
};

/// Looks at every Vulkan device; with `self_test`, runs a known-answer model on each usable one.
/// Never fails: a machine without Vulkan has an empty list, and `advice` says why. `probe`: as
/// Config::probe.
[[nodiscard]] FLOWDLO_EXPORT DeviceSurvey survey_devices(bool self_test, bool probe = true);

}  // namespace flowdlo
