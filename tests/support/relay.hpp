// Relay: a Vulkan driver that hands every call to another one (RELAY_TARGET in the environment: its
// library), and at one of them does what drivers may do: it fails. It counts the calls that the
// engine makes and the objects that are alive. A test opens the same library and talks to it by
// this table, which relay() gives.
#pragma once

#include <cstdint>

namespace flowdlo::testing {

/// What a device says of itself where it is clamped. 0: as the other driver says.
struct RelayLimits {
  bool shuffles = true;      ///< between lanes of a subgroup
  bool size_control = true;  ///< of subgroups
  bool float_texels = true;  ///< uniform texel buffers of RGBA32F
  std::uint32_t subgroup_size = 0;
  std::uint32_t shared_bytes = 0;  ///< of a workgroup
  std::uint32_t invocations = 0;   ///< of a workgroup
  std::uint32_t push_bytes = 0;
  std::uint32_t texels = 0;           ///< of a texel buffer
  std::uint32_t storage_buffers = 0;  ///< of a stage
  std::uint32_t api_version = 0;
  bool portability = false;       ///< has VK_KHR_portability_subset, and insists on it
  std::uint32_t least_lanes = 0;  ///< of a subgroup, where its size may be chosen
  std::uint32_t most_lanes = 0;
  bool memory_apart = false;  ///< a memory of its own that no host sees, and a host's that is not
                              ///< coherent
};

struct RelayTable {
  /// Forgets every count and the fault; objects that are alive stay so.
  void (*reset)();
  /// From now on the `nth` call of `function` (1: the next) gives `result` and does nothing. A lost
  /// device stays lost until the next is made.
  void (*fail)(const char* function, long nth, std::int32_t result);
  /// Whether that call has come.
  bool (*failed)();
  /// Whether a submission failed or the device is lost: what was submitted counts as done then.
  bool (*lost)();
  /// Calls of `function` since the last reset.
  long (*calls)(const char* function);
  /// Objects that were created or allocated, and not yet destroyed or freed.
  long (*alive)();
  /// Calls itself a discrete GPU, as long as this is set, whatever the other one is.
  void (*pose_as_gpu)(bool);
  /// From now on devices are clamped so.
  void (*limit)(const RelayLimits&);
  /// There is no device, as long as this is set.
  void (*hide)(bool);
};

}  // namespace flowdlo::testing
