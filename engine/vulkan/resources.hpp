// Resources: the tensors of a program, laid out in three buffers: inputs, outputs, the device's
// own.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "vulkan/binding.hpp"
#include "vulkan/buffer.hpp"

namespace flowdlo::vulkan {

enum class Home : std::uint8_t {
  kInput,   ///< written by the host
  kOutput,  ///< read by the host
  kDevice,  ///< scratch and constants
};

class Resources {
 public:
  /// Declares a resource; `content` is what it holds from the start, zeros where empty.
  std::uint32_t add(Home home, VkDeviceSize bytes, std::string_view name,
                    std::vector<float> content = {});

  /// Lays everything out and allocates. The host's memory is zero, and so is a CPU driver's, which
  /// gets its constants at once; other devices are filled by the commands of record_upload.
  [[nodiscard]] Result<void> allocate(const Device& device);

  /// Zeros, then the constants, into the device's buffer. What a dispatch needs is visible to it.
  /// `staging` must live until the commands have run.
  [[nodiscard]] Result<Buffer> record_upload(const Device& device, VkCommandBuffer commands);

  struct Place {
    VkBuffer buffer;
    VkDeviceSize offset;
  };
  [[nodiscard]] Place place(const Range& range) const;
  [[nodiscard]] Range whole(std::uint32_t id) const { return {id, 0, items_[id].bytes}; }
  [[nodiscard]] Home home(std::uint32_t id) const { return items_[id].home; }
  [[nodiscard]] const std::string& name(std::uint32_t id) const { return items_[id].name; }
  /// The host's view of an input or output.
  [[nodiscard]] std::span<float> host(std::uint32_t id) const;

  [[nodiscard]] Result<void> flush_inputs(const Device& d) const { return buffers_[0].flush(d); }
  [[nodiscard]] Result<void> invalidate_outputs(const Device& device) const {
    return buffers_[1].invalidate(device);
  }

 private:
  struct Item {
    Home home;
    VkDeviceSize bytes;
    VkDeviceSize offset = 0;
    std::string name;
    std::vector<float> content;
  };

  [[nodiscard]] std::array<VkDeviceSize, 3> lay_out();
  void fill_own();

  std::vector<Item> items_;
  std::array<Buffer, 3> buffers_;  // by Home
};

}  // namespace flowdlo::vulkan
