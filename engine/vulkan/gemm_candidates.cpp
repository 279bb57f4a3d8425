#include "vulkan/gemm_candidates.hpp"

#include <algorithm>
#include <array>

#include "vulkan/shader_code.hpp"

namespace flowdlo::vulkan {
namespace {

// A CPU driver keeps the tile in its stack frame and likes it large, as long as one round of the
// inner loop fits into what a core keeps of instructions: 25 kB of code on Zen 5, half of that on
// Zen 3. A GPU keeps it in registers.
constexpr std::array kCpuSimds{GemmChoice{GemmFamily::kSimd, 32, 8, 1},
                               GemmChoice{GemmFamily::kSimd, 16, 8, 1},
                               GemmChoice{GemmFamily::kSimd, 16, 4, 2}};
constexpr GemmChoice kGpuSimd{GemmFamily::kSimd, 8, 4, 1};
// 256 x 256 must still give each core of a GPU work: small tiles come first.
constexpr std::array kTiles{GemmChoice{GemmFamily::kTile, 32, 32, 16},
                            GemmChoice{GemmFamily::kTile, 32, 64, 16},
                            GemmChoice{GemmFamily::kTile, 64, 64, 16}};
constexpr std::array kMatrices{GemmChoice{GemmFamily::kMatrix, 32, 32, 64},
                               GemmChoice{GemmFamily::kMatrix, 64, 64, 64}};
constexpr int kPanelColumns = 256;
constexpr int kFours = 4;  // columns of y that a lane of kSimd writes at once

std::uint32_t shared_bytes(const GemmChoice& choice) {
  const auto rows = static_cast<std::uint32_t>(choice.rows);
  const auto columns = static_cast<std::uint32_t>(choice.columns);
  const auto depth = static_cast<std::uint32_t>(choice.depth);
  if (choice.family == GemmFamily::kTile) return 16 * depth * (rows / 4 + columns / 4 + 2);
  return 16 * rows * (depth / 8 + 1 + columns / 4 + 1);
}

bool fits(const PhysicalDevice& device, const GemmChoice& choice) {
  const auto threads = static_cast<std::uint32_t>(threads_of(choice, device));
  const std::uint32_t buffers = choice.family == GemmFamily::kMatrix ? 5 : 4;
  return buffers <= device.limits.maxPerStageDescriptorStorageBuffers &&
         threads <= device.limits.maxComputeWorkGroupInvocations &&
         threads <= device.limits.maxComputeWorkGroupSize[0] &&
         shared_bytes(choice) <= device.limits.maxComputeSharedMemorySize;
}

void add_simd(const PhysicalDevice& device, GemmChoice choice, std::vector<GemmChoice>& to) {
  if (!device.shuffles) return;
  choice.columns = std::min(choice.columns, kPanelColumns / device.lanes);
  const bool known = std::find(to.begin(), to.end(), choice) != to.end();
  if (choice.columns >= kFours && !known) to.push_back(choice);
}

}  // namespace

int threads_of(const GemmChoice& choice, const PhysicalDevice& device) {
  constexpr int kEntriesOfThread = 4 * 4;
  const int entries = choice.rows * choice.columns;
  if (choice.family == GemmFamily::kTile) return entries / kEntriesOfThread;
  return entries / (2 * device.matrix_edge * device.matrix_edge) * device.lanes;
}

std::vector<GemmChoice> gemm_candidates(const PhysicalDevice& device) {
  std::vector<GemmChoice> candidates;
  const bool is_cpu = device.report.kind == DeviceKind::kCpu;
  if (is_cpu) {
    for (const GemmChoice& choice : kCpuSimds) add_simd(device, choice, candidates);
  }
  const bool has_matrices = device.matrix_edge > 0 && !shaders::matrix_gemm().words.empty();
  if (has_matrices && !is_cpu) {
    for (const GemmChoice& choice : kMatrices) {
      if (fits(device, choice)) candidates.push_back(choice);
    }
  }
  for (const GemmChoice& choice : kTiles) {
    if (fits(device, choice)) candidates.push_back(choice);
  }
  if (!is_cpu) add_simd(device, kGpuSimd, candidates);
  if (has_matrices && is_cpu) candidates.push_back(kMatrices.front());
  return candidates;
}

}  // namespace flowdlo::vulkan
