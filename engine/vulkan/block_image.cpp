#include "vulkan/block_image.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "vulkan/kernels.hpp"
#include "vulkan/recorders.hpp"

namespace flowdlo::vulkan {
namespace {

constexpr int kMapEntries = 12;     // a row of the map
constexpr int kChannels = 16;       // an image's are a multiple of these
constexpr int kTexelsOfLane = 8;    // as in the shaders max_pool and add_upsampled
constexpr int kMostGroups = 65535;  // along one axis, what Vulkan promises
constexpr VkDeviceSize kTexelBytes = 16;

bool is_image(const ops::Tensor& image, const ops::Tensor& map, int side) {
  return (side == 16 || side == 8 || side == 4) && image.rows == map.rows * side * side &&
         image.columns > 0 && image.columns % kChannels == 0;
}

/// Workgroups of max_pool and add_upsampled: a block each along x, its texels along y.
Groups groups_of(const Plan& plan, Window blocks, int places, int quads) {
  const int share = plan.lanes() * kTexelsOfLane;
  return {static_cast<std::uint32_t>(blocks.count),
          static_cast<std::uint32_t>((places * quads + share - 1) / share)};
}

}  // namespace

bool are_images(Plan& plan, std::string_view op, const ops::Tensor& map, const ops::Tensor& x,
                int x_side, const ops::Tensor& y, int y_side) {
  if (map.rows > 0 && map.columns == kMapEntries && is_image(x, map, x_side) &&
      is_image(y, map, y_side)) {
    return true;
  }
  plan.fault(fmt::format(
      "{}: expected map [n, 12], x [{} n, 16 i] and y [{} n, 16 j] of sides 16, 8 or 4, "
      "got map [{}, {}], x [{}, {}] and y [{}, {}]",
      op, x_side * x_side, y_side * y_side, map.rows, map.columns, x.rows, x.columns, y.rows,
      y.columns));
  return false;
}

std::vector<Window> block_windows(const Plan& plan, const ops::Tensor& map, int most) {
  return Plan::windows(map.rows, std::min(most, plan.most_texels() / kMapEntries));
}

Window places_of(Window blocks, int side) {
  return {blocks.first * side * side, blocks.count * side * side};
}

void record_max_pool(Plan& plan, const ops::MaxPool& op) {
  if (!are_images(plan, "MaxPool", op.map, op.x, op.side, op.y, op.side / 2)) return;
  if (op.x.columns != op.y.columns) {
    plan.fault(fmt::format("MaxPool: expected as many channels in y as in x, got {} and {}",
                           op.y.columns, op.x.columns));
    return;
  }
  const int half = op.side / 2;
  for (const Window blocks : block_windows(plan, op.map, kMostGroups)) {
    const Range x = plan.rows(op.x, places_of(blocks, op.side));
    const MaxPoolCall call{.x_texels = {plan.cut(x, kTexelBytes)},
                           .x = {x},
                           .map = {plan.rows(op.map, blocks)},
                           .y = {plan.rows(op.y, places_of(blocks, half))}};
    plan.dispatch(call,
                  {.lanes = plan.lanes(),
                   .side = op.side,
                   .quads = op.x.columns / 4,
                   .x_is_texels = plan.fits(x, kTexelBytes) ? 1 : 0},
                  {}, groups_of(plan, blocks, half * half, op.x.columns / 4));
  }
}

void record_add_upsampled(Plan& plan, const ops::AddUpsampled& op) {
  if (!are_images(plan, "AddUpsampled", op.map, op.x, op.side / 2, op.y, op.side)) return;
  if (op.x.columns != op.y.columns) {
    plan.fault(fmt::format("AddUpsampled: expected as many channels in y as in x, got {} and {}",
                           op.y.columns, op.x.columns));
    return;
  }
  for (const Window blocks : block_windows(plan, op.map, kMostGroups)) {
    const Range x = plan.rows(op.x, places_of(blocks, op.side / 2));
    const Range y = plan.rows(op.y, places_of(blocks, op.side));
    const AddUpsampledCall call{.x_texels = {plan.cut(x, kTexelBytes)},
                                .x = {x},
                                .map = {plan.rows(op.map, blocks)},
                                .y_texels = {plan.cut(y, kTexelBytes)},
                                .y = {y}};
    plan.dispatch(call,
                  {.lanes = plan.lanes(),
                   .side = op.side,
                   .quads = op.x.columns / 4,
                   .they_are_texels = plan.fits(y, kTexelBytes) ? 1 : 0},
                  {}, groups_of(plan, blocks, op.side * op.side, op.x.columns / 4));
  }
}

}  // namespace flowdlo::vulkan
