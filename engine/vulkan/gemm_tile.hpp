// GemmTile: the register tile of the gemm kernel, chosen by the kind of device.
#pragma once

#include "vulkan/physical_device.hpp"

namespace flowdlo::vulkan {

struct GemmTile {
  int rows = 16;    ///< of y, a workgroup; divides 64
  int columns = 8;  ///< of y, a lane; lanes * columns divides 256
  int unroll = 2;   ///< texels of four k in flight
};

/// The same for any number of rows, so that a draw's bits do not depend on how many there are.
[[nodiscard]] GemmTile gemm_tile(const PhysicalDevice& device);

}  // namespace flowdlo::vulkan
