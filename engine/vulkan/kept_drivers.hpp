// KeptDrivers: a GPU's driver, once a device of it was opened, stays loaded until the process ends.
//
// The loader takes a driver out of the process with its last instance and brings it back with the
// next. NVIDIA's does not stand that for long: after some ten turns subgroups get wrong numbers
// (seen by others), and a process that had opened and closed forty devices, the last four at once,
// was told that there is no driver (580.159, H200).
#pragma once

#include <memory>
#include <string>

namespace flowdlo::vulkan {

class Instance;

/// Keeps `instance` alive, and so what it has loaded, unless one of this driver is kept already.
/// `driver`: its UUID.
void keep_driver(const std::string& driver, const std::shared_ptr<const Instance>& instance);

/// Tests' way to be a new process: none is kept any more.
void forget_drivers();

}  // namespace flowdlo::vulkan
