#include <algorithm>

#include "vulkan/kernels.hpp"
#include "vulkan/recorders.hpp"

namespace flowdlo::vulkan {

namespace {

// Of layers whose weights come as f32, few where a model's file holds f16: half the rows of other
// tiles take a CPU driver half as long to compile.
constexpr int kRowsOfFew = 16;

}  // namespace

/// Rows and columns in windows that texel buffers can hold.
void record_simd_gemm(Plan& plan, const ops::Linear& op, const DenseLayer& layer) {
  GemmChoice tile = plan.gemm();
  if (!layer.pairs) tile.rows = std::min(tile.rows, kRowsOfFew);
  const int panel_texels = layer.in / 4 * kColumns;
  const int most_panels = std::max(plan.most_texels() / panel_texels, 1);
  // Without a residual zeros are added, all rows the same: one kernel less to compile, at 5 % of
  // such a layer's time.
  const bool adds = op.residual || op.activation == ops::Activation::kNone;
  const int residual_pitch = op.residual ? plan.pitch(*op.residual) : 0;
  const int row_texels = std::max(plan.pitch(op.x), residual_pitch) / 4;

  for (const Window rows : Plan::windows(op.x.rows, plan.most_texels() / row_texels)) {
    for (int panel = 0; panel < layer.out / kColumns; panel += most_panels) {
      const int panels = std::min(most_panels, layer.out / kColumns - panel);
      const VkDeviceSize panel_bytes =
          VkDeviceSize{layer.pairs ? 8U : 16U} * static_cast<VkDeviceSize>(panel_texels);
      const Range weight{layer.weight.id, panel_bytes * static_cast<VkDeviceSize>(panel),
                         panel_bytes * static_cast<VkDeviceSize>(panels)};
      const Range bias = plan.whole(layer.bias);
      const GemmCall call{.x = {plan.rows(op.x, rows)},
                          .weight = {weight},
                          .bias = {bias},
                          .residual = {op.residual ? plan.rows(*op.residual, rows)
                                                   : (adds ? plan.zeros(layer.out) : bias)},
                          .y = {plan.rows(op.y, rows)},
                          .pairs = {weight}};
      plan.dispatch(call,
                    {.lanes = plan.lanes(),
                     .tile_rows = tile.rows,
                     .tile_columns = tile.columns,
                     .unroll = tile.depth,
                     .activation = static_cast<int>(op.activation),
                     .has_residual = adds ? 1 : 0,
                     .has_pairs = layer.pairs ? 1 : 0},
                    {.row_quads = plan.pitch(op.y) / 4,
                     .residual_quads = residual_pitch / 4,
                     .first_quad = panel * kColumns / 4},
                    {static_cast<std::uint32_t>(ops::kRowsPerDraw / tile.rows),
                     static_cast<std::uint32_t>(panels * kColumns / (plan.lanes() * tile.columns)),
                     static_cast<std::uint32_t>(rows.count / ops::kRowsPerDraw)});
    }
  }
}

}  // namespace flowdlo::vulkan
