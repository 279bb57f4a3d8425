#include <fmt/format.h>

#include "vulkan/kernels.hpp"
#include "vulkan/recorders.hpp"

namespace flowdlo::vulkan {
namespace {

constexpr int kRows = 16;         // a workgroup's, as in the shader
constexpr int kTexelsOfRow = 64;  // 256 channels
constexpr VkDeviceSize kTexelBytes = 16;

/// What one window of rows sees of an addend's table.
struct Slice {
  Range table;
  int period = 1;
  int offset = 0;
};

bool fits_whole(const Plan& plan, const std::optional<ops::Addend>& addend) {
  return !addend || plan.fits(plan.whole(addend->table), kTexelBytes);
}

/// A table too large for a texel buffer is bound by the draw: 64 rows, all within one period.
Slice slice_of(const Plan& plan, const ops::Addend& addend, Window window) {
  if (fits_whole(plan, addend)) return {plan.whole(addend.table), addend.period, addend.offset};
  const int first = window.first % addend.period + addend.offset;
  return {plan.rows(addend.table, {first, window.count}), addend.period, addend.offset - first};
}

bool sound(Plan& plan, const ops::Narrow& op, const DenseLayer& layer) {
  const bool fits = layer.packing == Packing::kNarrow && layer.in <= op.x.columns &&
                    (op.x.columns == 4 || op.x.columns == 8) && op.y.columns == ops::kWidth &&
                    op.x.rows == op.y.rows && op.x.rows % ops::kRowsPerDraw == 0;
  if (!fits) {
    plan.fault(
        fmt::format("Narrow: expected x [64 n, 4 or 8] of at least {} columns and y [64 n, "
                    "256], got x [{}, {}] and y [{}, {}]",
                    layer.in, op.x.rows, op.x.columns, op.y.rows, op.y.columns));
  }
  for (const auto& addend : {op.first, op.second}) {
    if (fits_whole(plan, addend) || addend->period % ops::kRowsPerDraw == 0) continue;
    plan.fault(
        fmt::format("Narrow: expected an addend of at most {} rows, or a period of 64 n, "
                    "got {} rows and a period of {}",
                    plan.most_texels() / kTexelsOfRow, addend->table.rows, addend->period));
    return false;
  }
  return fits;
}

}  // namespace

void record_narrow(Plan& plan, const ops::Narrow& op, const DenseLayer& layer) {
  if (!sound(plan, op, layer)) return;
  const Range weight = plan.whole(layer.weight);
  const std::optional<ops::Addend> first = op.first ? op.first : op.second;
  const std::optional<ops::Addend> second = op.first ? op.second : std::nullopt;
  const bool by_draw = !fits_whole(plan, first) || !fits_whole(plan, second);

  for (const Window rows : Plan::windows(op.x.rows, by_draw ? ops::kRowsPerDraw : op.x.rows)) {
    const Slice none{weight, 1, 0};
    const Slice one = first ? slice_of(plan, *first, rows) : none;
    const Slice two = second ? slice_of(plan, *second, rows) : none;
    const NarrowCall call{.x = {plan.rows(op.x, rows)},
                          .weight = {weight},
                          .bias = {plan.whole(layer.bias)},
                          .first = {one.table},
                          .second = {two.table},
                          .y = {plan.rows(op.y, rows)}};
    plan.dispatch(call,
                  {.lanes = plan.lanes(),
                   .x_texels = op.x.columns / 4,
                   .inputs = layer.in,
                   .activation = static_cast<int>(op.activation),
                   .addends = (first ? 1 : 0) + (second ? 1 : 0)},
                  {.first_row = rows.first,
                   .first_period = one.period,
                   .first_offset = one.offset,
                   .second_period = two.period,
                   .second_offset = two.offset},
                  {static_cast<std::uint32_t>((kTexelsOfRow + plan.lanes() - 1) / plan.lanes()),
                   static_cast<std::uint32_t>(rows.count / kRows)});
  }
}

}  // namespace flowdlo::vulkan
