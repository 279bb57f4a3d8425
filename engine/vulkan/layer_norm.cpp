#include <fmt/format.h>

#include <algorithm>

#include "vulkan/kernels.hpp"
#include "vulkan/recorders.hpp"

namespace flowdlo::vulkan {
namespace {

constexpr int kMostGroups = 65535;  // along one axis, what Vulkan promises

}  // namespace

void record_layer_norm(Plan& plan, const ops::LayerNorm& op) {
  if (op.x.columns != ops::kWidth || op.y.columns != ops::kWidth || op.x.rows != op.y.rows ||
      op.x.id == op.y.id) {
    plan.fault(
        fmt::format("LayerNorm: expected x and another y, [R, 256], got x [{}, {}] and y "
                    "[{}, {}]",
                    op.x.rows, op.x.columns, op.y.rows, op.y.columns));
    return;
  }
  const int across = plan.hands_round() ? 1 : plan.lanes();
  const int most_rows = std::min(plan.most_texels() / (ops::kWidth / 4), kMostGroups);
  for (const Window rows : Plan::windows(op.x.rows, most_rows)) {
    const LayerNormCall call{.x = {plan.rows(op.x, rows)},
                             .gain = {plan.whole(op.gain)},
                             .shift = {plan.whole(op.shift)},
                             .y = {plan.rows(op.y, rows)}};
    const int rows_a_group = across > 1 ? 1 : plan.lanes();
    plan.dispatch(call, {.lanes = plan.lanes(), .across = across}, {},
                  {static_cast<std::uint32_t>((rows.count + rows_a_group - 1) / rows_a_group)});
  }
}

}  // namespace flowdlo::vulkan
