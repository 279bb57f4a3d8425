#include "vulkan/backend.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "vulkan/absence.hpp"
#include "vulkan/program.hpp"

namespace flowdlo::vulkan {
namespace {

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

bool fits_name(const DeviceReport& report, const std::string& wanted) {
  if (lower(wanted) == "vulkan") return true;
  std::string uuid = lower(wanted);
  uuid.erase(std::remove(uuid.begin(), uuid.end(), '-'), uuid.end());
  return lower(report.name).find(lower(wanted)) != std::string::npos ||
         (!report.uuid.empty() && uuid == report.uuid);
}

std::string joined(const std::vector<std::string>& parts) {
  std::string text;
  for (const std::string& part : parts) {
    if (!text.empty()) text += ", ";
    text += part;
  }
  return text;
}

/// Why a device cannot be taken; empty where it can.
std::string objection(const PhysicalDevice& device, const Selection& selection) {
  const DeviceReport& report = device.report;
  if (!fits_name(report, selection.wanted)) {
    return fmt::format("is not \"{}\"", selection.wanted);
  }
  if (!report.lacks.empty()) return "lacks " + joined(report.lacks);
  if (!selection.allow_cpu_driver && report.kind == DeviceKind::kCpu) {
    return "is a CPU driver, which must be asked for by name, by UUID or as \"vulkan\"";
  }
  return {};
}

Error refusal(const std::vector<PhysicalDevice>& devices, const Selection& selection) {
  if (devices.empty()) return no_device();
  std::string text;
  for (const PhysicalDevice& device : devices) {
    text += fmt::format("{}\"{}\": {}", text.empty() ? "" : "; ", device.report.name,
                        objection(device, selection));
  }
  return none_usable(text);
}

}  // namespace

int preference(DeviceKind kind) {
  switch (kind) {
    case DeviceKind::kDiscreteGpu:
      return 0;
    case DeviceKind::kIntegratedGpu:
      return 1;
    case DeviceKind::kVirtualGpu:
      return 2;
    case DeviceKind::kOther:
      return 3;
    case DeviceKind::kCpu:
      return 4;
  }
  return 4;
}

Survey survey() {
  Survey result;
  const auto loader = Loader::open();
  if (loader) result.loader = (*loader)->version();
  const auto instance = Instance::create(false);
  if (!instance) {
    result.advice = instance.error().message;
    return result;
  }
  const std::vector<PhysicalDevice> devices = physical_devices(**instance);
  bool usable = false;
  for (const PhysicalDevice& device : devices) {
    usable = usable || objection(device, Selection{}).empty();
    result.devices.push_back(device.report);
  }
  if (!usable) result.advice = refusal(devices, Selection{}).message;
  return result;
}

Result<std::shared_ptr<Device>> open_device(const Selection& selection) {
  auto instance = Instance::create(selection.validation);
  if (!instance) return instance.error();
  const std::vector<PhysicalDevice> devices = physical_devices(**instance);
  const PhysicalDevice* best = nullptr;
  for (const PhysicalDevice& device : devices) {
    if (!objection(device, selection).empty()) continue;
    if (best == nullptr || preference(device.report.kind) < preference(best->report.kind))
      best = &device;
  }
  if (best == nullptr) return refusal(devices, selection);
  return Device::open(*std::move(instance), *best);
}

const DeviceReport& report(const Device& device) { return device.facts().report; }

std::vector<std::string> validation_messages(const Device& device) {
  return device.instance().log().messages();
}

bool validation_active(const Device& device) { return device.instance().validates(); }

std::string gemm_name(Device& device) {
  const std::lock_guard lock(device.tuning_mutex());
  return device.gemm() ? name_of(*device.gemm()) : std::string{};
}

std::uint64_t submit_count(const Device& device) { return device.submit_count(); }

std::unique_ptr<ops::Program> create_program(std::shared_ptr<Device> device,
                                             const ProgramOptions& options) {
  return std::make_unique<Program>(std::move(device), options);
}

}  // namespace flowdlo::vulkan
