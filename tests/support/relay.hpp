// Relay: a Vulkan driver that hands every call to another one (RELAY_TARGET in the environment: its
// library), and at one of them does what drivers may do: it fails. It counts the calls that the
// engine makes and the objects that are alive. A test opens the same library and talks to it by
// this table, which relay() gives.
#pragma once

#include <cstdint>

namespace flowdlo::testing {

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
  /// There is no device, as long as this is set.
  void (*hide)(bool);
};

}  // namespace flowdlo::testing
