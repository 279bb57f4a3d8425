#include "gpu_compile/absent_gpu.hpp"

#include <fmt/format.h>

#include <cstdlib>

#include "vulkan/driver_manifests.hpp"

namespace flowdlo::gpu_compile {

std::string radv_library() {
  for (const auto& manifest : vulkan::driver_manifests(
           [](const char* name) { return static_cast<const char*>(std::getenv(name)); })) {
    if (manifest.filename().string().find("radeon") != std::string::npos) {
      return vulkan::driver_library(manifest);
    }
  }
  return {};
}

Result<std::shared_ptr<vulkan::Device>> open_absent_gpu(const std::string& family, int lanes) {
  const std::string library = radv_library();
  if (library.empty()) {
    return Error{ErrorCode::kNoDevice,
                 "RADV is not installed (Debian and Ubuntu: mesa-vulkan-drivers)"};
  }
  ::setenv("RADV_FORCE_FAMILY", family.c_str(), 1);
  auto loader = vulkan::Loader::open_driver(library);
  if (!loader) return loader.error();
  auto instance = vulkan::Instance::create(*std::move(loader), /*validation=*/false);
  if (!instance) return instance.error();
  auto devices = vulkan::physical_devices(**instance);
  if (devices.size() != 1 || devices[0].report.name.find("Null hardware") == std::string::npos) {
    return Error{ErrorCode::kNoDevice,
                 fmt::format("RADV_FORCE_FAMILY={}: expected one device without hardware, got {}; "
                             "install Mesa 22.3 or newer",
                             family, devices.empty() ? "none" : devices[0].report.name)};
  }
  vulkan::PhysicalDevice& gpu = devices[0];
  gpu.keeps_statistics = true;
  if (lanes > 0 && gpu.fixes_lanes) gpu.lanes = lanes;
  return vulkan::Device::open(*std::move(instance), gpu);
}

}  // namespace flowdlo::gpu_compile
