// tile_gemm: y[r, c] = act(sum_k x[r, k] W[c, k] + bias[c]) + residual[r, c], for GPUs
//
//   thesis    Sec. 3.4, every dense layer of the cross-attention and the encoder
//   in        x         [rows, K]  f32
//             weight    [N, K]     f32, or f16 where half_weights is set
//             bias      [N]        f32, as RGBA texels
//             residual  [rows, N]  f32; may be y
//   out       y         [rows, N]  f32
//   dispatch  (rows / tile_rows rounded up, N / tile_columns, 1), a workgroup of
//             tile_rows / 4 * tile_columns / 4; a thread owns 4 rows x 4 columns
//   twin      engine/reference/linear.cpp; agrees to 2e-5 * sqrt(K / 256) of the largest output
//
// Slabs of x and W go through shared memory, k first, so that a thread's inner loop reads two vec4
// for 16 multiply-adds; the next slab is on its way in registers meanwhile. No subgroups, f32 sums,
// k in order: a result does not depend on the tile.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "activation.glsl"
#include "push_constants.h"

layout(constant_id = 0) const int threads = 64;
layout(constant_id = 1) const int tile_rows = 32;
layout(constant_id = 2) const int tile_columns = 32;
layout(constant_id = 3) const int slab = 16;         // k in shared memory; a multiple of 8
layout(constant_id = 4) const int depth = 256;       // K, a multiple of slab
layout(constant_id = 5) const int half_weights = 0;
layout(constant_id = 6) const int activation = 0;    // ops::Activation
layout(constant_id = 7) const int has_residual = 0;
layout(local_size_x_id = 0) in;

layout(push_constant) uniform Push { TileGemmPush push; };
layout(binding = 0, std430) readonly buffer X { vec4 x[]; };
layout(binding = 1, std430) readonly buffer Weight { uvec4 weight[]; };  // 4 floats or 8 halves
layout(binding = 2) uniform samplerBuffer bias;  // the fifth storage buffer is one too many for some
layout(binding = 3, std430) readonly buffer Residual { vec4 residual[]; };
layout(binding = 4, std430) writeonly buffer Y { vec4 y[]; };

// Rows of shared memory are a quad longer than the tile: neighbours fall into other banks.
const int x_stride = tile_rows / 4 + 1;
const int w_stride = tile_columns / 4 + 1;
shared vec4 x_tile[slab * x_stride];  // [k][row]
shared vec4 w_tile[slab * w_stride];  // [k][column]

const int k_a_load = half_weights != 0 ? 8 : 4;
const int x_loads = tile_rows * slab / 4;
const int w_loads = tile_columns * slab / k_a_load;
const int x_share = (x_loads + threads - 1) / threads;  // of a thread
const int w_share = (w_loads + threads - 1) / threads;

void main() {
  int thread = int(gl_LocalInvocationID.x);
  int tx = thread % (tile_columns / 4);
  int ty = thread / (tile_columns / 4);
  int first_row = int(gl_WorkGroupID.x) * tile_rows;
  int first_column = int(gl_WorkGroupID.y) * tile_columns;
  int quad = first_column / 4 + tx;

  vec4 sum[4];
  [[unroll]] for (int i = 0; i < 4; ++i) sum[i] = texelFetch(bias, quad);

  vec4 x_next[x_share];
  uvec4 w_next[w_share];
  for (int k = -slab; k < depth; k += slab) {
    if (k >= 0) {
      barrier();
      [[unroll]] for (int s = 0; s < x_share; ++s) {
        int load = s * threads + thread;
        int row = load / (slab / 4);
        int at = load % (slab / 4) * 4;
        if (load < x_loads) {
          [[unroll]] for (int e = 0; e < 4; ++e) {
            x_tile[(at + e) * x_stride + row / 4][row % 4] = x_next[s][e];
          }
        }
      }
      [[unroll]] for (int s = 0; s < w_share; ++s) {
        int load = s * threads + thread;
        int column = load / (slab / k_a_load);
        int at = load % (slab / k_a_load) * k_a_load;
        if (load < w_loads) {
          [[unroll]] for (int e = 0; e < k_a_load; ++e) {
            float value;
            if (half_weights != 0) {
              value = unpackHalf2x16(w_next[s][e / 2])[e % 2];
            } else {
              value = uintBitsToFloat(w_next[s][e % 4]);
            }
            w_tile[(at + e) * w_stride + column / 4][column % 4] = value;
          }
        }
      }
      barrier();
    }
    int next = k + slab;
    if (next < depth) {
      [[unroll]] for (int s = 0; s < x_share; ++s) {
        int load = min(s * threads + thread, x_loads - 1);
        int row = min(first_row + load / (slab / 4), push.rows - 1);
        x_next[s] = x[row * (depth / 4) + next / 4 + load % (slab / 4)];
      }
      [[unroll]] for (int s = 0; s < w_share; ++s) {
        int load = min(s * threads + thread, w_loads - 1);
        int column = first_column + load / (slab / k_a_load);
        w_next[s] = weight[column * (depth / k_a_load) + next / k_a_load + load % (slab / k_a_load)];
      }
    }
    if (k >= 0) {
      [[unroll]] for (int kk = 0; kk < slab; ++kk) {
        vec4 of_x = x_tile[kk * x_stride + ty];
        vec4 of_w = w_tile[kk * w_stride + tx];
        [[unroll]] for (int i = 0; i < 4; ++i) sum[i] += of_x[i] * of_w;
      }
    }
  }

  [[unroll]] for (int i = 0; i < 4; ++i) {
    int row = first_row + ty * 4 + i;
    if (row < push.rows) {
      vec4 value = sum[i];
      if (activation == 1) {
        [[unroll]] for (int c = 0; c < 4; ++c) value[c] = gelu(value[c]);
      }
      int place = row * push.row_quads + quad;
      if (has_residual != 0) value += residual[place];
      y[place] = value;
    }
  }
}
