// gemm: y[r, c] = act(sum_k x[r, k] W[c, k] + bias[c]) + residual[r, c]
//
//   thesis    Sec. 3.4, every dense layer of the cross-attention and the encoder
//   in        x         [rows, K]           f32, as RGBA texels
//             weight    [N/256][K/4][256]   RGBA texels: four consecutive k of one column
//             bias      [N]                 f32, as R texels
//             residual  [rows, N]           f32, as R texels; may be y
//   out       y         [rows, N]           f32
//   dispatch  (columns / (lanes * tile_columns), rows / tile_rows, 1), one subgroup a workgroup
//   twin      engine/reference/linear.cpp; agrees to 2e-5 * sqrt(K / 256) of the largest output
//
// A lane owns tile_columns columns, `lanes` apart, of all tile_rows rows. The rows of x are spread
// over the lanes and handed round by shuffles with a constant lane, so that the inner loop has no
// lane-varying load but texel fetches. k runs in order: a result does not depend on the tile.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_EXT_control_flow_attributes : require
#include "activation.glsl"
#include "push_constants.h"

layout(constant_id = 0) const int lanes = 8;
layout(constant_id = 1) const int depth = 256;      // K
layout(constant_id = 2) const int tile_rows = 16;
layout(constant_id = 3) const int tile_columns = 8;
layout(constant_id = 4) const int unroll = 2;       // texels of four k in flight
layout(constant_id = 5) const int activation = 0;   // ops::Activation
layout(constant_id = 6) const int has_residual = 0;
layout(local_size_x_id = 0) in;

layout(push_constant) uniform Push { GemmPush push; };
layout(binding = 0) uniform samplerBuffer x;
layout(binding = 1) uniform samplerBuffer weight;
layout(binding = 2) uniform samplerBuffer bias;
layout(binding = 3) uniform samplerBuffer residual;
layout(binding = 4, std430) writeonly buffer Y { float y[]; };

const int kPanel = 256;  // columns that lie side by side in `weight`
const int texels_a_row = depth / 4;
const int row_texels = (tile_rows + lanes - 1) / lanes;  // a lane's share of a column of x's tile

void main() {
  int lane = int(gl_LocalInvocationID.x);
  int first_row = int(gl_WorkGroupID.y) * tile_rows;
  int column = int(gl_WorkGroupID.x) * lanes * tile_columns + lane;  // within this dispatch
  int out_column = push.first_column + column;

  float sum[tile_rows * tile_columns];
  [[unroll]] for (int j = 0; j < tile_columns; ++j) {
    float start = texelFetch(bias, out_column + j * lanes).x;
    [[unroll]] for (int i = 0; i < tile_rows; ++i) {
      sum[i * tile_columns + j] = start;
      if (has_residual != 0 && activation == 0) {
        sum[i * tile_columns + j] +=
            texelFetch(residual, (first_row + i) * push.columns + out_column + j * lanes).x;
      }
    }
  }

  int weight_base = column / kPanel * (texels_a_row * kPanel) + column % kPanel;
  int x_base[row_texels];
  [[unroll]] for (int f = 0; f < row_texels; ++f) {
    x_base[f] = (first_row + (f * lanes + lane) % tile_rows) * texels_a_row;
  }

  for (int k = 0; k < texels_a_row; k += unroll) {
    vec4 a[unroll * row_texels];
    vec4 b[unroll * tile_columns];
    [[unroll]] for (int u = 0; u < unroll; ++u) {
      [[unroll]] for (int f = 0; f < row_texels; ++f) {
        a[u * row_texels + f] = texelFetch(x, x_base[f] + k + u);
      }
      [[unroll]] for (int j = 0; j < tile_columns; ++j) {
        b[u * tile_columns + j] = texelFetch(weight, weight_base + (k + u) * kPanel + j * lanes);
      }
    }
    [[unroll]] for (int i = 0; i < tile_rows; ++i) {
      vec4 x_row[unroll];
      [[unroll]] for (int u = 0; u < unroll; ++u) {
        vec4 held = a[u * row_texels + i / lanes];
        uint holder = uint(i % lanes);
        x_row[u] = vec4(subgroupShuffle(held.x, holder), subgroupShuffle(held.y, holder),
                        subgroupShuffle(held.z, holder), subgroupShuffle(held.w, holder));
      }
      [[unroll]] for (int j = 0; j < tile_columns; ++j) {
        float total = sum[i * tile_columns + j];
        [[unroll]] for (int u = 0; u < unroll; ++u) {
          vec4 w = b[u * tile_columns + j];
          total += x_row[u].x * w.x;
          total += x_row[u].y * w.y;
          total += x_row[u].z * w.z;
          total += x_row[u].w * w.w;
        }
        sum[i * tile_columns + j] = total;
      }
    }
  }

  [[unroll]] for (int i = 0; i < tile_rows; ++i) {
    [[unroll]] for (int j = 0; j < tile_columns; ++j) {
      int index = (first_row + i) * push.columns + out_column + j * lanes;
      float value = sum[i * tile_columns + j];
      if (activation == 1) {
        value = gelu(value);
        if (has_residual != 0) value += texelFetch(residual, index).x;
      }
      y[index] = value;
    }
  }
}
