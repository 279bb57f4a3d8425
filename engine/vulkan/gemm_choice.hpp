// GemmChoice: which kernel runs the dense layers on a device, and with which tile.
#pragma once

#include <cstdint>
#include <string>

namespace flowdlo::vulkan {

enum class GemmFamily : std::uint32_t {
  kSimd,    ///< gemm: registers and shuffles, what CPU drivers like
  kTile,    ///< tile_gemm: shared memory, for GPUs; f16 weights where nothing is lost
  kMatrix,  ///< matrix_gemm: cooperative matrices, f16 in and f32 sums
};

struct GemmChoice {
  GemmFamily family = GemmFamily::kSimd;
  std::int32_t rows = 16;    ///< of y, a workgroup
  std::int32_t columns = 8;  ///< of y: a lane's in kSimd, a workgroup's otherwise
  std::int32_t depth = 2;    ///< texels of four k in flight in kSimd, k in shared memory otherwise

  bool operator==(const GemmChoice&) const = default;
};

/// "tile 32 x 32 x 16"
[[nodiscard]] std::string name_of(const GemmChoice& choice);

}  // namespace flowdlo::vulkan
