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
// for 16 multiply-adds; what they need next is on its way meanwhile: the next slab from memory, the
// next k from shared memory. No subgroups, f32 sums, k in order: a result does not depend on the
// tile. Indices are unsigned and computed before the loop, which a GPU's compiler leaves where they
// stand; what is fetched is never fetched within a branch, at whose end it would be waited for.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "activation.glsl"
#include "push_constants.h"

layout(constant_id = 0) const uint threads = 64;
layout(constant_id = 1) const uint tile_rows = 32;
layout(constant_id = 2) const uint tile_columns = 32;
layout(constant_id = 3) const uint slab = 16;        // k in shared memory; a multiple of 8
layout(constant_id = 4) const uint depth = 256;      // K, a multiple of slab
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
const uint x_stride = tile_rows / 4 + 1;
const uint w_stride = tile_columns / 4 + 1;
shared vec4 x_tile[slab * x_stride];  // [k][row]
shared vec4 w_tile[slab * w_stride];  // [k][column]

const uint k_a_load = half_weights != 0 ? 8 : 4;
const uint x_loads = tile_rows * slab / 4;
const uint w_loads = tile_columns * slab / k_a_load;
const uint x_share = (x_loads + threads - 1) / threads;  // of a thread
const uint w_share = (w_loads + threads - 1) / threads;
const uint x_loads_a_row = slab / 4;
const uint w_loads_a_row = slab / k_a_load;

// Of a value that a thread puts into shared memory: the quad of k = 0, and which of its four.
struct Slot {
  uint quad;
  uint entry;
};

Slot slot_of(uint load, uint loads_a_row, uint k_of_load, uint stride) {
  uint line = load / loads_a_row;
  return Slot(load % loads_a_row * k_of_load * stride + line / 4, line % 4);
}

void main() {
  uint thread = gl_LocalInvocationID.x;
  uint tx = thread % (tile_columns / 4);
  uint ty = thread / (tile_columns / 4);
  uint first_row = gl_WorkGroupID.x * tile_rows;
  uint first_column = gl_WorkGroupID.y * tile_columns;
  uint quad = first_column / 4 + tx;
  uint rows = uint(push.rows);

  uint x_from[x_share];
  Slot x_to[x_share];
  vec4 x_next[x_share];
  [[unroll]] for (uint s = 0; s < x_share; ++s) {
    uint load = min(s * threads + thread, x_loads - 1);
    uint row = min(first_row + load / x_loads_a_row, rows - 1);
    x_from[s] = row * (depth / 4) + load % x_loads_a_row;
    x_to[s] = slot_of(load, x_loads_a_row, 4, x_stride);
    x_next[s] = x[x_from[s]];
  }
  uint w_from[w_share];
  Slot w_to[w_share];
  uvec4 w_next[w_share];
  [[unroll]] for (uint s = 0; s < w_share; ++s) {
    uint load = min(s * threads + thread, w_loads - 1);
    uint column = first_column + load / w_loads_a_row;
    w_from[s] = column * (depth / k_a_load) + load % w_loads_a_row;
    w_to[s] = slot_of(load, w_loads_a_row, k_a_load, w_stride);
    w_next[s] = weight[w_from[s]];
  }

  vec4 sum[4];
  [[unroll]] for (int i = 0; i < 4; ++i) sum[i] = texelFetch(bias, int(quad));

  for (uint k = 0; k < depth; k += slab) {
    barrier();
    [[unroll]] for (uint s = 0; s < x_share; ++s) {
      if (x_loads % threads == 0 || s * threads + thread < x_loads) {
        [[unroll]] for (uint e = 0; e < 4; ++e) {
          x_tile[x_to[s].quad + e * x_stride][x_to[s].entry] = x_next[s][e];
        }
      }
    }
    [[unroll]] for (uint s = 0; s < w_share; ++s) {
      if (w_loads % threads == 0 || s * threads + thread < w_loads) {
        [[unroll]] for (uint e = 0; e < k_a_load; ++e) {
          float value;
          if (half_weights != 0) {
            value = unpackHalf2x16(w_next[s][e / 2])[e % 2];
          } else {
            value = uintBitsToFloat(w_next[s][e % 4]);
          }
          w_tile[w_to[s].quad + e * w_stride][w_to[s].entry] = value;
        }
      }
    }
    barrier();

    uint next = min(k + slab, depth - slab);  // the last one once more: cheaper than a branch
    [[unroll]] for (uint s = 0; s < x_share; ++s) x_next[s] = x[x_from[s] + next / 4];
    [[unroll]] for (uint s = 0; s < w_share; ++s) w_next[s] = weight[w_from[s] + next / k_a_load];

    vec4 of_x = x_tile[ty];
    vec4 of_w = w_tile[tx];
    [[unroll]] for (uint kk = 0; kk < slab; ++kk) {
      uint after = min(kk + 1, slab - 1);
      vec4 next_x = x_tile[after * x_stride + ty];
      vec4 next_w = w_tile[after * w_stride + tx];
      [[unroll]] for (int i = 0; i < 4; ++i) sum[i] += of_x[i] * of_w;
      of_x = next_x;
      of_w = next_w;
    }
  }

  [[unroll]] for (uint i = 0; i < 4; ++i) {
    uint row = first_row + ty * 4 + i;
    if (row < rows) {
      vec4 value = sum[i];
      if (activation == 1) {
        [[unroll]] for (int c = 0; c < 4; ++c) value[c] = gelu(value[c]);
      }
      uint place = row * uint(push.row_quads) + quad;
      if (has_residual != 0) value += residual[place];
      y[place] = value;
    }
  }
}
