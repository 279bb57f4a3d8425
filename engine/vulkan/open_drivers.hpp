// OpenDrivers: the instances through which this machine's devices are seen.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "vulkan/instance.hpp"
#include "vulkan/probe.hpp"

namespace flowdlo::vulkan {

struct OpenDrivers {
  std::string loader = "none";  ///< version of the Vulkan loader
  Probed probed;
  /// One of the loader's with every driver, or, where a driver crashed or hung when it was asked,
  /// one of each other driver without the loader, which would load them all.
  std::vector<std::unique_ptr<Instance>> instances;
  std::optional<Error> failure;  ///< kNoDevice, where there is no instance
};

/// Without the loader there are no layers, and `validation` has no effect.
[[nodiscard]] OpenDrivers open_drivers(bool validation, const Probing& probing);

}  // namespace flowdlo::vulkan
