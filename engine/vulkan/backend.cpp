#include "vulkan/backend.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <utility>

#include "vulkan/absence.hpp"
#include "vulkan/findings.hpp"
#include "vulkan/open_drivers.hpp"
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

Error refusal(const std::vector<PhysicalDevice>& devices, const Selection& selection,
              const Probed& probed) {
  if (devices.empty()) return no_device();
  std::string text;
  for (const PhysicalDevice& device : devices) {
    text += fmt::format("{}\"{}\": {}", text.empty() ? "" : "; ", device.report.name,
                        objection(device, selection));
  }
  if (probed.any_bad()) text += "; left alone: " + probed.bad();
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

Survey survey(const Probing& probing) {
  OpenDrivers opened = open_drivers(/*validation=*/false, probing);
  Survey result{.devices = {},
                .loader = std::move(opened.loader),
                .advice = {},
                .probed = std::move(opened.probed)};
  if (opened.failure) {
    result.advice = opened.failure->message;
    return result;
  }
  std::vector<PhysicalDevice> devices;
  for (const auto& instance : opened.instances) {
    for (PhysicalDevice& device : physical_devices(*instance)) devices.push_back(std::move(device));
  }
  bool usable = false;
  for (const PhysicalDevice& device : devices) {
    usable = usable || objection(device, Selection{}).empty();
    result.devices.push_back(device.report);
  }
  if (!usable) result.advice = refusal(devices, Selection{}, result.probed).message;
  return result;
}

Result<std::shared_ptr<Device>> open_device(const Selection& selection) {
  OpenDrivers opened = open_drivers(selection.validation, selection.probing);
  if (opened.failure) return *opened.failure;
  std::vector<PhysicalDevice> devices;
  std::vector<std::size_t> owners;  // of each device the instance
  for (std::size_t i = 0; i < opened.instances.size(); ++i) {
    for (PhysicalDevice& device : physical_devices(*opened.instances[i])) {
      devices.push_back(std::move(device));
      owners.push_back(i);
    }
  }
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < devices.size(); ++i) {
    if (!objection(devices[i], selection).empty()) continue;
    const auto rank = [&](std::size_t which) { return preference(devices[which].report.kind); };
    if (!best || rank(i) < rank(*best)) best = i;
  }
  if (!best) return refusal(devices, selection, opened.probed);
  return Device::open(std::move(opened.instances[owners[*best]]), devices[*best]);
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

Result<bool> settled(const Device& device, const std::filesystem::path& folder,
                     std::string_view kind, const std::function<Result<bool>()>& find_out) {
  std::vector<char> answer = known(device, folder, kind);
  if (answer.size() != 1) {
    const auto found = find_out();
    if (!found) return found.error();
    answer = settle(device, folder, kind, {static_cast<char>(*found ? 1 : 0)});
  }
  return answer.front() != 0;
}

std::uint64_t submit_count(const Device& device) { return device.submit_count(); }

std::unique_ptr<ops::Program> create_program(std::shared_ptr<Device> device,
                                             const ProgramOptions& options) {
  return std::make_unique<Program>(std::move(device), options);
}

}  // namespace flowdlo::vulkan
