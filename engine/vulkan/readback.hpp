// Readback: frames in buffers of the host's device, copied to where the processor reads them.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "flowdlo/frame.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo {
struct VulkanFrame;
}

namespace flowdlo::vulkan {

class Device;

/// For one thread. It sets memory aside for the largest frame so far.
class Readback {
 public:
  /// `timeout_ms`: what one may take, and with it what it waits for.
  Readback(std::shared_ptr<Device> device, int timeout_ms);
  /// Waits a bounded time for a copy that timed out. What a hung device still holds is given up,
  /// not freed.
  ~Readback();
  Readback(const Readback&) = delete;
  Readback& operator=(const Readback&) = delete;

  /// Views into this object, good until the next one. Fails with kBadInput, naming every fault,
  /// kDeviceLost or kOutOfMemory. What the frame signals comes once what it waits for has come, but
  /// where a semaphore is null; with the latter two errors it may not.
  [[nodiscard]] Result<Frame> read(const VulkanFrame& frame);

 private:
  struct Work;

  std::unique_ptr<Work> work_;
  int timeout_ms_;
  std::vector<float> depth_m_;
  std::vector<std::uint8_t> mask_;
};

}  // namespace flowdlo::vulkan
