#include <fmt/format.h>

#include "vulkan/kernels.hpp"
#include "vulkan/recorders.hpp"

namespace flowdlo::vulkan {
namespace {

void record_affine(Plan& plan, const ops::Tensor& points, const ops::Tensor& norm,
                   const ops::Tensor& out, bool inverse_form) {
  if (points.columns != 4 || out.columns != 4 || points.rows != out.rows || norm.columns != 4) {
    plan.fault(fmt::format("{}: expected [R, 4] to [R, 4] by [1, 4], got [{}, {}] to [{}, {}]",
                           inverse_form ? "Denormalize" : "Normalize", points.rows, points.columns,
                           out.rows, out.columns));
    return;
  }
  for (const Window rows : Plan::windows(points.rows, plan.most_texels())) {
    const NormalizeCall call{.points = {plan.rows(points, rows)},
                             .norm = {plan.whole(norm)},
                             .result = {plan.rows(out, rows)}};
    plan.dispatch(call, {.lanes = plan.lanes(), .inverse_form = inverse_form ? 1 : 0}, {},
                  {static_cast<std::uint32_t>((rows.count + plan.lanes() - 1) / plan.lanes())});
  }
}

}  // namespace

void record_frame_normalization(Plan& plan, const ops::FrameNormalization& op) {
  if (op.points.columns != 4 || op.points.rows != ops::kVisibleRows || op.norm.columns != 4) {
    plan.fault(fmt::format("FrameNormalization: expected points [256, 4], got [{}, {}]",
                           op.points.rows, op.points.columns));
    return;
  }
  plan.dispatch(FrameNormalizationCall{{plan.whole(op.points)}, {plan.whole(op.norm)}},
                {.lanes = plan.lanes()}, {}, {});
}

void record_normalize(Plan& plan, const ops::Normalize& op) {
  record_affine(plan, op.points, op.norm, op.out, false);
}

void record_denormalize(Plan& plan, const ops::Denormalize& op) {
  record_affine(plan, op.state, op.norm, op.out, true);
}

}  // namespace flowdlo::vulkan
