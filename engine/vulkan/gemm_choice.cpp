#include "vulkan/gemm_choice.hpp"

#include <fmt/format.h>

#include <array>

namespace flowdlo::vulkan {

std::string name_of(const GemmChoice& choice) {
  constexpr std::array kNames{"simd", "tile", "matrix"};
  return fmt::format("{} {} x {} x {}", kNames[static_cast<std::size_t>(choice.family)],
                     choice.rows, choice.columns, choice.depth);
}

}  // namespace flowdlo::vulkan
