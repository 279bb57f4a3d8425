#include <fmt/format.h>

#include "vulkan/kernels.hpp"
#include "vulkan/recorders.hpp"

namespace flowdlo::vulkan {

void record_mask_features(Plan& plan, const ops::MaskFeatures& op) {
  if (op.state.columns != 4 || op.out.columns != 8 || op.state.rows != op.out.rows ||
      op.field.columns != 4 || op.params.columns != 16 || (op.depth && op.depth->columns != 1)) {
    plan.fault(
        fmt::format("MaskFeatures: expected state [R, 4], field [F, 4], out [R, 8], got "
                    "[{}, {}], [{}, {}], [{}, {}]",
                    op.state.rows, op.state.columns, op.field.rows, op.field.columns, op.out.rows,
                    op.out.columns));
    return;
  }
  const Range field = plan.whole(op.field);
  // Without a depth image its bindings hold the field, which nobody then reads as depth.
  const Range depth = op.depth ? plan.whole(*op.depth) : field;
  for (const Window rows : Plan::windows(op.state.rows, plan.most_texels())) {
    const MaskFeaturesCall call{.state = {plan.rows(op.state, rows)},
                                .norm = {plan.whole(op.norm)},
                                .params = {plan.whole(op.params)},
                                .field_texels = {plan.cut(field, 16)},
                                .field = {field},
                                .depth_texels = {plan.cut(depth, 4)},
                                .depth = {depth},
                                .phi = {plan.rows(op.out, rows)}};
    plan.dispatch(call,
                  {.lanes = plan.lanes(),
                   .field_is_texels = plan.fits(field, 16) ? 1 : 0,
                   .depth_is_texels = plan.fits(depth, 4) ? 1 : 0,
                   .has_depth = op.depth ? 1 : 0},
                  {.field_texels = op.field.rows, .depth_pixels = op.depth ? op.depth->rows : 1},
                  {static_cast<std::uint32_t>((rows.count + plan.lanes() - 1) / plan.lanes())});
  }
}

}  // namespace flowdlo::vulkan
