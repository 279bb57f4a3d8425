// Which back end a Config asks for, opened.
#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "flow/sampler.hpp"
#include "flowdlo/config.hpp"
#include "flowdlo/frame.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo {
struct VulkanFrame;
struct VulkanHost;
}  // namespace flowdlo

namespace flowdlo::estimator {

/// A frame in buffers of the host's device as one in memory, good until the next.
using Fetch = std::function<Result<Frame>(const VulkanFrame&)>;

inline constexpr const char* kAuto = "auto";  ///< Config::device, where it is left to us
inline constexpr const char* kCpu = "cpu";    ///< the native back end's name

/// The answer to a question about a device that can only be measured: asked once, so that all
/// estimators on the device go by the same (vulkan::settled).
using Settled = std::function<Result<bool>(std::string_view kind,
                                           const std::function<Result<bool>()>& find_out)>;

struct BackEnd {
  std::string name;  ///< kCpu, or the Vulkan device's name
  flow::ProgramFactory make_program;
  Fetch fetch{};      ///< of a device that the host handed over; of others empty
  bool gpu = false;   ///< a real one, no CPU driver
  Settled settled{};  ///< of the native back end empty
};

[[nodiscard]] BackEnd cpu_back_end(int threads);

/// Fails with kNoDevice. "auto" never fails: a machine without a GPU that works has a CPU.
[[nodiscard]] Result<BackEnd> choose_back_end(const Config& config);

/// On the host's device, with "auto" once its self-test passes. Fails with kBadInput and kNoDevice.
[[nodiscard]] Result<BackEnd> host_back_end(const Config& config, const VulkanHost& host);

}  // namespace flowdlo::estimator
