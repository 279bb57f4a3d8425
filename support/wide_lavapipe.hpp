// Wide lavapipe: Mesa's CPU driver with 16 lanes instead of 8, where that is faster and right.
#pragma once

#include <string>

#include "flowdlo/devices.hpp"

namespace flowdlo::support {

/// Whether sixteen lanes do no harm to this device: no lavapipe, or that of Mesa 22.3. Later ones
/// shuffle wrongly at that width.
[[nodiscard]] bool bears_sixteen_lanes(const DeviceReport& device);

/// Before the first use of Vulkan, for what --device says. Where it may mean lavapipe, the
/// processor has AVX-512 and LP_NATIVE_VECTOR_WIDTH is not set: sets it to 512 bits, looks at the
/// devices, and where one does not bear it runs this program anew with 256. Mesa reads it once a
/// process.
void widen_lavapipe(const std::string& wanted_device);

}  // namespace flowdlo::support
