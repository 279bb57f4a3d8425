#include "vulkan/open_drivers.hpp"

#include <utility>

#include "vulkan/absence.hpp"
#include "vulkan/driver_manifests.hpp"

namespace flowdlo::vulkan {

OpenDrivers open_drivers(bool validation, const Probing& probing) {
  OpenDrivers opened;
  auto loader = Loader::open();
  if (!loader) {
    opened.failure = loader.error();
    return opened;
  }
  opened.loader = (*loader)->version();
  opened.probed = probe(probing, opened.loader);
  if (!opened.probed.any_bad()) {
    auto instance = Instance::create(*loader, validation);
    if (instance) {
      opened.instances.push_back(*std::move(instance));
    } else {
      opened.failure = instance.error();
    }
    return opened;
  }
  for (const DriverReport& driver : opened.probed.drivers) {
    // Those without a device include what the loader passes over: broken manifests, filters.
    if (!driver.used || driver.devices == 0) continue;
    auto own = Loader::open_driver(driver_library(driver.manifest));
    if (!own) continue;
    auto instance = Instance::create(*own, validation);
    if (instance) opened.instances.push_back(*std::move(instance));
  }
  if (opened.instances.empty()) opened.failure = only_bad_drivers(opened.probed.bad());
  return opened;
}

}  // namespace flowdlo::vulkan
