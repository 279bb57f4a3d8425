#include <fmt/format.h>

#include "vulkan/kernels.hpp"
#include "vulkan/recorders.hpp"

namespace flowdlo::vulkan {

void record_layer_norm(Plan& plan, const ops::LayerNorm& op) {
  if (op.x.columns != ops::kWidth || op.y.columns != ops::kWidth || op.x.rows != op.y.rows ||
      op.x.id == op.y.id) {
    plan.fault(
        fmt::format("LayerNorm: expected x and another y, [R, 256], got x [{}, {}] and y "
                    "[{}, {}]",
                    op.x.rows, op.x.columns, op.y.rows, op.y.columns));
    return;
  }
  for (const Window rows : Plan::windows(op.x.rows, plan.most_texels() / (ops::kWidth / 4))) {
    const LayerNormCall call{.x = {plan.rows(op.x, rows)},
                             .gain = {plan.whole(op.gain)},
                             .shift = {plan.whole(op.shift)},
                             .y = {plan.rows(op.y, rows)}};
    plan.dispatch(call, {.lanes = plan.lanes()}, {},
                  {static_cast<std::uint32_t>((rows.count + plan.lanes() - 1) / plan.lanes())});
  }
}

}  // namespace flowdlo::vulkan
