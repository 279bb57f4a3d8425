// The Vulkan back end as the other rooms see it: which devices there are, opening one, programs on
// it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "flowdlo/devices.hpp"
#include "flowdlo/result.hpp"
#include "ops/program.hpp"
#include "vulkan/gemm_choice.hpp"
#include "vulkan/probe.hpp"

namespace flowdlo {
struct VulkanHost;
}

namespace flowdlo::vulkan {

class Device;
class Plan;

struct Selection {
  /// "vulkan": any device, GPUs first (discrete, integrated, virtual, other, CPU). Anything else:
  /// part of a name, in any case, or a UUID with or without dashes.
  std::string wanted = "vulkan";
  bool allow_cpu_driver = true;  ///< false: lavapipe, SwiftShader and the like are passed over
  bool validation = false;       ///< core and synchronization validation, where the layer is there
  Probing probing{};
};

struct Survey {
  std::vector<DeviceReport> devices;  ///< in the drivers' order; the self-test fields are empty
  std::string loader = "none";        ///< version of the Vulkan loader
  std::string advice;  ///< where no device is usable: why, and what to install; otherwise empty
  Probed probed;
};

/// Every Vulkan device with what it lacks. Never fails: no Vulkan, no devices.
[[nodiscard]] Survey survey(const Probing& probing = {});

/// Order of preference, 0 first: discrete, integrated, virtual GPUs, then others, CPU drivers last.
[[nodiscard]] int preference(DeviceKind kind);

/// Opens the best device that fits. Fails with kNoDevice and one sentence a device. Devices are
/// independent of one another: each has its own instance.
[[nodiscard]] Result<std::shared_ptr<Device>> open_device(const Selection& selection);

/// The host's device, which is never destroyed here. Fails with kBadInput, naming every fault of
/// `host`, and with kNoDevice, naming everything that its device lacks.
[[nodiscard]] Result<std::shared_ptr<Device>> adopt_device(const VulkanHost& host);

[[nodiscard]] const DeviceReport& report(const Device& device);

/// What the validation layers said since the device was opened, oldest first.
[[nodiscard]] std::vector<std::string> validation_messages(const Device& device);
/// Whether the layers are there and watch this device.
[[nodiscard]] bool validation_active(const Device& device);
/// How dense layers run on this device, "tile 32 x 32 x 16"; empty before its first program.
[[nodiscard]] std::string gemm_name(Device& device);
/// The answer to a question about this device that can only be measured: `find_out` is asked once,
/// and its answer kept in this process and, unless it is empty, in `folder` (findings). `kind`: the
/// question's name, at most 16 characters. Fails as `find_out` does, and asks again then.
[[nodiscard]] Result<bool> settled(const Device& device, const std::filesystem::path& folder,
                                   std::string_view kind,
                                   const std::function<Result<bool>()>& find_out);
/// Calls of vkQueueSubmit on this device so far, whoever made them.
[[nodiscard]] std::uint64_t submit_count(const Device& device);

struct ProgramOptions {
  int timeout_ms = 10000;  ///< a run that takes longer fails with kDeviceLost
  /// A folder for compiled pipelines and for the choice of kernels; empty: none is kept.
  std::filesystem::path pipeline_cache;
  std::optional<GemmChoice> gemm = std::nullopt;  ///< how dense layers run; none: found out
  /// Tests' way of making a kernel's results wrong where they are checked.
  std::function<void(const GemmChoice&, std::span<float>)> disturb = nullptr;
  /// Given, build() shows it what was recorded, and makes nothing of it: for devices that are known
  /// to a compiler alone. Needs `gemm`.
  std::function<void(const Plan&)> inspect = nullptr;
};

/// A program for one device; several may share a device, also across threads. After a run that
/// timed out or lost the device, every further run fails with the same error.
[[nodiscard]] std::unique_ptr<ops::Program> create_program(std::shared_ptr<Device> device,
                                                           const ProgramOptions& options = {});

}  // namespace flowdlo::vulkan
