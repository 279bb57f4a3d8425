#include <fmt/format.h>

#include "vulkan/recorders.hpp"

namespace flowdlo::vulkan {
namespace {

bool sound(Plan& plan, const ops::Linear& op, const DenseLayer& layer) {
  const bool fits = is_gemm(layer.packing) && op.x.columns == layer.in &&
                    op.y.columns == layer.out && op.x.rows == op.y.rows &&
                    op.x.rows % ops::kRowsPerDraw == 0;
  if (!fits) {
    plan.fault(
        fmt::format("Linear: expected x [64 n, {}] and y [64 n, {}], got x [{}, {}] and y "
                    "[{}, {}]",
                    layer.in, layer.out, op.x.rows, op.x.columns, op.y.rows, op.y.columns));
  }
  return fits;
}

}  // namespace

void record_linear(Plan& plan, const ops::Linear& op, const DenseLayer& layer) {
  if (!sound(plan, op, layer)) return;
  if (layer.packing == Packing::kPanels) {
    record_simd_gemm(plan, op, layer);
  } else {
    record_tile_gemm(plan, op, layer);
  }
}

}  // namespace flowdlo::vulkan
