#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <limits>

#include "vulkan/block_image.hpp"
#include "vulkan/kernels.hpp"
#include "vulkan/recorders.hpp"

namespace flowdlo::vulkan {
namespace {

constexpr int kPlaces = 4;          // of a lane, side by side, as in the shader
constexpr int kMostGroups = 65535;  // along one axis, what Vulkan promises
constexpr int kMostAround = 16384;  // inputs of a block and the places around it
constexpr VkDeviceSize kTexelBytes = 16;

bool sound(Plan& plan, const ops::Convolution& op, const ConvolutionWeights& layer) {
  if (layer.taps == 0) return false;  // a fault already
  if (!are_images(plan, "Convolution", op.map, op.x, op.side, op.y, op.side)) return false;
  if (op.x.columns == layer.in && op.y.columns == layer.out && op.x.id != op.y.id &&
      (op.side + 2) * (op.side + 2) * layer.in <= kMostAround) {
    return true;
  }
  plan.fault(fmt::format(
      "Convolution: expected {} channels of x, {} of another y and (side + 2)^2 * {} of "
      "at most {}, got {}, {} and a side of {}",
      layer.in, layer.out, layer.in, kMostAround, op.x.columns, op.y.columns, op.side));
  return false;
}

}  // namespace

/// Blocks and outputs in windows that texel buffers and grids can hold. The inputs lie anywhere:
/// they are bound as a whole.
void record_convolution(Plan& plan, const ops::Convolution& op, const ConvolutionWeights& layer) {
  if (!sound(plan, op, layer)) return;
  const int places = op.side * op.side;
  const int most_blocks = kMostGroups * plan.lanes() / (places / kPlaces);
  const int group_texels = layer.taps * layer.in / 4 * kConvolutionOutputs;
  const int most_groups = std::min(plan.most_texels() / group_texels, kMostGroups);
  const int all_groups = layer.out / kConvolutionOutputs;
  const Range x = plan.whole(op.x);

  for (const Window blocks : block_windows(plan, op.map, most_blocks)) {
    const int fours = blocks.count * places / kPlaces;
    for (int group = 0; group < all_groups; group += most_groups) {
      const int groups = std::min(most_groups, all_groups - group);
      const Range weight =
          plan.rows(layer.weight, {group * kConvolutionOutputs, groups * kConvolutionOutputs});
      const ConvolutionCall call{.x_texels = {plan.cut(x, kTexelBytes)},
                                 .x = {x},
                                 .map = {plan.rows(op.map, blocks)},
                                 .weight_texels = {weight},
                                 .weight = {weight},
                                 .bias = {plan.whole(layer.bias)},
                                 .y = {plan.rows(op.y, places_of(blocks, op.side))}};
      plan.dispatch(call,
                    {.lanes = plan.lanes(),
                     .taps_across = layer.taps == 9 ? 3 : 1,
                     .x_is_texels = plan.fits(x, kTexelBytes) ? 1 : 0,
                     .hands_round = plan.hands_round() ? 1 : 0},
                    {.side_bits = std::countr_zero(static_cast<unsigned>(op.side)),
                     .fours = fours,
                     .x_quads = plan.pitch(op.x) / 4,
                     .y_quads = plan.pitch(op.y) / 4,
                     .first_quad = group * kConvolutionOutputs / 4,
                     .least = op.relu ? 0.0F : std::numeric_limits<float>::lowest()},
                    {static_cast<std::uint32_t>((fours + plan.lanes() - 1) / plan.lanes()),
                     static_cast<std::uint32_t>(groups)});
    }
  }
}

}  // namespace flowdlo::vulkan
