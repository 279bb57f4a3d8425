// BlockImage: what recorders know of images in blocks; see ops/program.hpp.
#pragma once

#include <string_view>
#include <vector>

#include "vulkan/plan.hpp"

namespace flowdlo::vulkan {

/// Whether x and y are images of these sides over one map, of 16 n channels each; if not, a fault
/// of the plan.
[[nodiscard]] bool are_images(Plan& plan, std::string_view op, const ops::Tensor& map,
                              const ops::Tensor& x, int x_side, const ops::Tensor& y, int y_side);

/// Blocks in windows whose rows of the map a texel buffer can hold, none of more than `most`, which
/// is at least 64.
[[nodiscard]] std::vector<Window> block_windows(const Plan& plan, const ops::Tensor& map, int most);

/// The places of a window of blocks.
[[nodiscard]] Window places_of(Window blocks, int side);

}  // namespace flowdlo::vulkan
