#include "vulkan/gemm_tile.hpp"

#include <algorithm>

namespace flowdlo::vulkan {
namespace {

// A CPU driver keeps the tile in its stack frame and likes it large.
constexpr GemmTile kCpuTile{.rows = 16, .columns = 8, .unroll = 2};
// A GPU keeps it in registers, and 256 x 256 must still give each core work.
constexpr GemmTile kGpuTile{.rows = 8, .columns = 4, .unroll = 1};
constexpr int kPanelColumns = 256;

}  // namespace

GemmTile gemm_tile(const PhysicalDevice& device) {
  GemmTile tile = device.report.kind == DeviceKind::kCpu ? kCpuTile : kGpuTile;
  tile.columns = std::min(tile.columns, kPanelColumns / device.lanes);
  return tile;
}

}  // namespace flowdlo::vulkan
