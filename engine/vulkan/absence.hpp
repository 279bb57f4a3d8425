// Absence: why there is no Vulkan device to be had, and what to install so that there is one.
#pragma once

#include <string_view>

#include "flowdlo/result.hpp"

namespace flowdlo::vulkan {

/// All kNoDevice. `reason`: the dynamic linker's, why it gave no loader.
[[nodiscard]] Error no_loader(std::string_view reason);
/// There is a loader, and no driver that it can load.
[[nodiscard]] Error no_driver();
/// There are drivers, and none of them found a device.
[[nodiscard]] Error no_device();
/// There are drivers, and those with a device crash or hang; `bad`: what each did.
[[nodiscard]] Error only_bad_drivers(std::string_view bad);
/// There are devices, and none can be taken; `objections`: what speaks against each.
[[nodiscard]] Error none_usable(std::string_view objections);

}  // namespace flowdlo::vulkan
