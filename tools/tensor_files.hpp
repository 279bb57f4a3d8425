// TensorFiles: what `flowdlo estimate --tensors` writes, spec section 3.
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "flowdlo/estimate.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::tools {

/// Every file name that tensor_files can return.
inline constexpr std::array<const char*, 12> kTensorFileNames = {
    "source.npy",     "visible.npy",    "visible_valid.npy", "path.npy",
    "prior.npy",      "support.npy",    "draw_prior.npy",    "draw_support.npy",
    "prediction.npy", "mask_field.npy", "field.npy",         "field_region.json"};

/// File name and bytes of each tensor, and where the strand field lies in the frame; those of the
/// strand field where there is one. Fails with kInternal when a tensor has not the shape that
/// `tensors` itself states.
[[nodiscard]] Result<std::vector<std::pair<std::string, std::string>>> tensor_files(
    const Tensors& tensors);

}  // namespace flowdlo::tools
