#include <fmt/format.h>

#include "vulkan/kernels.hpp"
#include "vulkan/recorders.hpp"

namespace flowdlo::vulkan {

void record_flow_step(Plan& plan, const ops::FlowStep& op, const DenseLayer& head) {
  if (head.packing != Packing::kHead || op.hidden.columns != ops::kWidth || op.state.columns != 4 ||
      op.prior.columns != 4 || op.state.rows != op.hidden.rows || op.prior.rows != op.hidden.rows) {
    plan.fault(
        fmt::format("FlowStep: expected hidden [R, 256], prior and state [R, 4], head "
                    "[3..4, 256], got [{}, {}], [{}, {}], [{}, {}], [{}, {}]",
                    op.hidden.rows, op.hidden.columns, op.prior.rows, op.prior.columns,
                    op.state.rows, op.state.columns, head.out, head.in));
    return;
  }
  for (const Window rows : Plan::windows(op.hidden.rows, plan.most_texels() / (ops::kWidth / 4))) {
    const FlowStepCall call{.hidden = {plan.rows(op.hidden, rows)},
                            .weight = {plan.whole(head.weight)},
                            .bias = {plan.whole(head.bias)},
                            .prior = {plan.rows(op.prior, rows)},
                            .state = {plan.rows(op.state, rows)}};
    plan.dispatch(call,
                  {.lanes = plan.lanes(),
                   .parameterization = static_cast<int>(op.parameterization),
                   .channels = head.out},
                  {.t = op.t, .dt = op.dt, .prior_sd = op.prior_sd},
                  {static_cast<std::uint32_t>((rows.count + plan.lanes() - 1) / plan.lanes())});
  }
}

}  // namespace flowdlo::vulkan
