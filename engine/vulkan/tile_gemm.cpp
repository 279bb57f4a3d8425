#include "vulkan/gemm_candidates.hpp"
#include "vulkan/kernels.hpp"
#include "vulkan/recorders.hpp"

namespace flowdlo::vulkan {
namespace {

constexpr std::int64_t kManyGroups = 512;  // enough for the widest GPU, even of large tiles

/// Large tiles read less, small ones keep more cores at work: with very many rows every core has
/// work in any case. A row's bits do not depend on the tile, for k is added up in order.
GemmChoice tile_for(const Plan& plan, const ops::Linear& op) {
  GemmChoice tile = plan.gemm();
  for (const GemmChoice& other : gemm_candidates(plan.device().facts())) {
    if (other.family != tile.family) continue;
    const std::int64_t groups =
        std::int64_t{op.y.rows / other.rows} * (op.y.columns / other.columns);
    if (groups >= kManyGroups && other.rows * other.columns > tile.rows * tile.columns)
      tile = other;
  }
  return tile;
}

}  // namespace

void record_tile_gemm(Plan& plan, const ops::Linear& op, const DenseLayer& layer) {
  const GemmChoice tile = tile_for(plan, op);
  const Reads x{plan.whole(op.x)};
  const Reads weight{plan.whole(layer.weight)};
  const Reads bias{plan.whole(layer.bias)};
  const Reads residual{op.residual ? plan.whole(*op.residual) : plan.whole(layer.bias)};
  const Writes y{plan.whole(op.y)};
  const int threads = threads_of(tile, plan.device().facts());
  const int activation = static_cast<int>(op.activation);
  const int has_residual = op.residual ? 1 : 0;
  const TileGemmPush push{.rows = op.x.rows, .row_quads = layer.out / 4};
  const Groups groups{static_cast<std::uint32_t>((op.x.rows + tile.rows - 1) / tile.rows),
                      static_cast<std::uint32_t>(layer.out / tile.columns)};

  if (tile.family == GemmFamily::kMatrix) {
    plan.dispatch(MatrixGemmCall{x, weight, bias, residual, y},
                  {.threads = threads,
                   .tile_rows = tile.rows,
                   .tile_columns = tile.columns,
                   .slab = tile.depth,
                   .depth = layer.in,
                   .edge = plan.device().facts().matrix_edge,
                   .activation = activation,
                   .has_residual = has_residual},
                  push, groups);
    return;
  }
  plan.dispatch(TileGemmCall{x, weight, {plan.whole(layer.bias)}, residual, y},
                {.threads = threads,
                 .tile_rows = tile.rows,
                 .tile_columns = tile.columns,
                 .slab = tile.depth,
                 .depth = layer.in,
                 .half_weights = layer.packing == Packing::kHalves ? 1 : 0,
                 .activation = activation,
                 .has_residual = has_residual},
                push, groups);
}

}  // namespace flowdlo::vulkan
