// matrix_gemm: y[r, c] = act(sum_k x[r, k] W[c, k] + bias[c]) + residual[r, c] by cooperative
// matrices: f16 in, f32 sums
//
//   thesis    Sec. 3.4, every dense layer of the cross-attention and the encoder
//   in        x         [rows, K]  f32, rounded to f16 on the way
//             weight    [N, K]     f16
//             bias      [N]        f32
//             residual  [rows, N]  f32; may be y
//   out       y         [rows, N]  f32
//   dispatch  (rows / tile_rows rounded up, N / tile_columns, 1), one subgroup for each `edge` rows
//             x 2 `edge` columns of the tile
//   twin      engine/reference/linear.cpp; agrees to 2e-3 of the largest output: x has 11 bits
//
// A slab of x goes through shared memory as halves; W is read where it lies. The sums return through
// shared memory, where every thread finds its share of bias, activation and residual.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_shader_explicit_arithmetic_types_float16 : require
#extension GL_KHR_cooperative_matrix : require
#extension GL_KHR_memory_scope_semantics : require
#extension GL_KHR_shader_subgroup_basic : require
#include "activation.glsl"
#include "push_constants.h"

layout(constant_id = 0) const int threads = 64;
layout(constant_id = 1) const int tile_rows = 32;
layout(constant_id = 2) const int tile_columns = 32;
layout(constant_id = 3) const int slab = 64;       // k in shared memory; a multiple of edge
layout(constant_id = 4) const int depth = 256;     // K, a multiple of slab
layout(constant_id = 5) const int edge = 16;       // of a matrix: 16 or 8, whatever the device has
layout(constant_id = 6) const int activation = 0;  // ops::Activation
layout(constant_id = 7) const int has_residual = 0;
layout(local_size_x_id = 0) in;

layout(push_constant) uniform Push { TileGemmPush push; };
layout(binding = 0, std430) readonly buffer X { vec4 x[]; };
layout(binding = 1, std430) readonly buffer Weight { uvec4 weight[]; };  // 8 halves each
layout(binding = 2, std430) readonly buffer Bias { vec4 bias[]; };
layout(binding = 3, std430) readonly buffer Residual { vec4 residual[]; };
layout(binding = 4, std430) writeonly buffer Y { vec4 y[]; };

const int kMatrices = 2;  // a subgroup's, side by side
const int x_stride = slab / 8 + 1;           // uvec4 of 8 halves; one more: other banks
const int sum_stride = tile_columns / 4 + 1;  // vec4
shared uvec4 x_tile[tile_rows * x_stride];
shared vec4 sums[tile_rows * sum_stride];

const int x_loads = tile_rows * slab / 8;
const int quads = tile_rows * tile_columns / 4;

void main() {
  int thread = int(gl_LocalInvocationID.x);
  int first_row = int(gl_WorkGroupID.x) * tile_rows;
  int first_column = int(gl_WorkGroupID.y) * tile_columns;
  int part = int(gl_SubgroupID);
  int part_row = part / (tile_columns / (edge * kMatrices)) * edge;
  int part_column = part % (tile_columns / (edge * kMatrices)) * (edge * kMatrices);

  coopmat<float, gl_ScopeSubgroup, edge, edge, gl_MatrixUseAccumulator> sum[kMatrices];
  [[unroll]] for (int j = 0; j < kMatrices; ++j) {
    sum[j] = coopmat<float, gl_ScopeSubgroup, edge, edge, gl_MatrixUseAccumulator>(0.0);
  }
  for (int k = 0; k < depth; k += slab) {
    barrier();
    for (int load = thread; load < x_loads; load += threads) {
      int row = min(first_row + load / (slab / 8), push.rows - 1);
      int at = row * (depth / 4) + k / 4 + load % (slab / 8) * 2;
      vec4 low = x[at];
      vec4 high = x[at + 1];
      x_tile[load / (slab / 8) * x_stride + load % (slab / 8)] =
          uvec4(packHalf2x16(low.xy), packHalf2x16(low.zw), packHalf2x16(high.xy),
                packHalf2x16(high.zw));
    }
    barrier();
    [[unroll]] for (int kk = 0; kk < slab; kk += edge) {
      coopmat<float16_t, gl_ScopeSubgroup, edge, edge, gl_MatrixUseA> of_x;
      coopMatLoad(of_x, x_tile, part_row * x_stride + kk / 8, x_stride,
                  gl_CooperativeMatrixLayoutRowMajor);
      [[unroll]] for (int j = 0; j < kMatrices; ++j) {
        coopmat<float16_t, gl_ScopeSubgroup, edge, edge, gl_MatrixUseB> of_w;
        int column = first_column + part_column + j * edge;
        coopMatLoad(of_w, weight, column * (depth / 8) + (k + kk) / 8, depth / 8,
                    gl_CooperativeMatrixLayoutColumnMajor);
        sum[j] = coopMatMulAdd(of_x, of_w, sum[j]);
      }
    }
  }

  [[unroll]] for (int j = 0; j < kMatrices; ++j) {
    coopMatStore(sum[j], sums, part_row * sum_stride + (part_column + j * edge) / 4, sum_stride,
                 gl_CooperativeMatrixLayoutRowMajor);
  }
  barrier();
  for (int i = thread; i < quads; i += threads) {
    int row = first_row + i / (tile_columns / 4);
    int quad = first_column / 4 + i % (tile_columns / 4);
    if (row < push.rows) {
      vec4 value =
          sums[i / (tile_columns / 4) * sum_stride + i % (tile_columns / 4)] + bias[quad];
      if (activation == 1) {
        [[unroll]] for (int c = 0; c < 4; ++c) value[c] = gelu(value[c]);
      }
      int place = row * push.row_quads + quad;
      if (has_residual != 0) value += residual[place];
      y[place] = value;
    }
  }
}
