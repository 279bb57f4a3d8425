// gemm: y[r, c] = act(sum_k x[r, k] W[c, k] + bias[c]) + residual[r, c]
//
//   thesis    Sec. 3.4, every dense layer of the cross-attention and the encoder
//   in        x         [rows, K]           f32, as RGBA texels; gaps between rows, as in y and
//                                           residual, are allowed
//             weight    [N/P][K/4][P]       f32, as RGBA texels: four consecutive k of one column;
//                                           P = lanes * tile_columns, so that a subgroup reads what
//                                           lies in one piece
//             pairs     [N/P][K/4][P/2]     instead where has_pairs is set: the same of two columns
//                                           side by side, each weight in half a word; see first_of
//             bias      [N]                 f32, as RGBA texels
//             residual  [rows, N]           f32, as RGBA texels; may be y
//   out       y         [rows, N]           f32
//   dispatch  (64 / tile_rows, columns / (lanes * tile_columns), rows / 64), one subgroup a workgroup;
//             draw by draw, so that what a core of a CPU driver reads is what it wrote before
//   twin      engine/reference/linear.cpp; agrees to 2e-5 * sqrt(K / 256) of the largest output
//
// A lane owns tile_columns columns of all tile_rows rows, in fours that lie `lanes` apart. The rows
// of x are spread over the lanes and handed round by shuffles with a constant lane, so that the inner
// loop has no lane-varying load but texel fetches. k runs in order: a result does not depend on the
// tile. K is read from the weights' size, so that one kernel serves every K: each costs CPU drivers 0.2 s.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#extension GL_EXT_control_flow_attributes : require
#include "activation.glsl"
#include "push_constants.h"

layout(constant_id = 0) const int lanes = 8;
layout(constant_id = 1) const int tile_rows = 32;    // a multiple of four
layout(constant_id = 2) const int tile_columns = 8;  // a multiple of four
layout(constant_id = 3) const int unroll = 1;        // texels of four k in flight; divides K / 4
layout(constant_id = 4) const int activation = 0;    // ops::Activation
layout(constant_id = 5) const int has_residual = 0;
layout(constant_id = 6) const int has_pairs = 0;     // weights are in `pairs`, not in `weight`
layout(local_size_x_id = 0) in;

layout(push_constant) uniform Push { GemmPush push; };
layout(binding = 0) uniform samplerBuffer x;
layout(binding = 1) uniform samplerBuffer weight;
layout(binding = 2) uniform samplerBuffer bias;
layout(binding = 3) uniform samplerBuffer residual;
layout(binding = 4, std430) writeonly buffer Y { vec4 y[]; };
layout(binding = 5) uniform usamplerBuffer pairs;

const int quads = tile_columns / 4;
const int kDrawRows = 64;
const int kRowBlock = 4;  // rows that share a weight in registers
const int row_texels = (tile_rows + lanes - 1) / lanes;  // a lane's share of a column of x's tile

// A weight has 11 significant bits and an exponent of 2^-31 to 2^0, whose upper bits are the same for
// all. The first of a word lies where a float has its bits; the second's are spread over the gaps. A
// texel costs a CPU driver as much as 50 instructions, and taking two weights apart 7.
const uint kCommon = 0x30000000u;  // exponent 96

vec4 first_of(uvec4 pair) { return uintBitsToFloat((pair & 0x8FFFE000u) | kCommon); }

vec4 second_of(uvec4 pair) {
  return uintBitsToFloat(((pair << 13) & 0x03FFE000u) | ((pair >> 2) & 0x0C000000u) |
                         ((pair << 1) & 0x80000000u) | kCommon);
}

void main() {
  int lane = int(gl_LocalInvocationID.x);
  int first_row = int(gl_WorkGroupID.z) * kDrawRows + int(gl_WorkGroupID.x) * tile_rows;
  int pitch = textureSize(x) / (int(gl_NumWorkGroups.z) * kDrawRows);  // at least K / 4
  int panel = lanes * tile_columns;
  int texels = has_pairs != 0 ? 2 * textureSize(pairs) : textureSize(weight);
  int texels_a_row = texels / (int(gl_NumWorkGroups.y) * panel);  // K / 4
  int quad = int(gl_WorkGroupID.y) * lanes * quads + lane;  // within this dispatch
  int out_quad = push.first_quad + quad;

  float sum[tile_rows * tile_columns];
  [[unroll]] for (int q = 0; q < quads; ++q) {
    vec4 start = texelFetch(bias, out_quad + q * lanes);
    [[unroll]] for (int i = 0; i < tile_rows; ++i) {
      vec4 value = start;
      if (has_residual != 0 && activation == 0) {
        value += texelFetch(residual, (first_row + i) * push.residual_quads + out_quad + q * lanes);
      }
      [[unroll]] for (int c = 0; c < 4; ++c) sum[i * tile_columns + q * 4 + c] = value[c];
    }
  }

  int weight_base = int(gl_WorkGroupID.y) * (texels_a_row * panel) + lane * 4;
  int x_base[row_texels];
  [[unroll]] for (int f = 0; f < row_texels; ++f) {
    x_base[f] = (first_row + (f * lanes + lane) % tile_rows) * pitch;
  }

  for (int k = 0; k < texels_a_row; k += unroll) {
    vec4 a[unroll * row_texels];
    vec4 b[unroll * tile_columns];
    [[unroll]] for (int u = 0; u < unroll; ++u) {
      [[unroll]] for (int f = 0; f < row_texels; ++f) {
        a[u * row_texels + f] = texelFetch(x, x_base[f] + k + u);
      }
      int first = weight_base + (k + u) * panel;
      [[unroll]] for (int j = 0; j < tile_columns; j += 2) {
        int column = j / 4 * lanes * 4 + j % 4;
        if (has_pairs != 0) {
          uvec4 pair = texelFetch(pairs, (first + column) / 2);
          b[u * tile_columns + j] = first_of(pair);
          b[u * tile_columns + j + 1] = second_of(pair);
        } else {
          b[u * tile_columns + j] = texelFetch(weight, first + column);
          b[u * tile_columns + j + 1] = texelFetch(weight, first + column + 1);
        }
      }
    }
    [[unroll]] for (int first = 0; first < tile_rows; first += kRowBlock) {
      vec4 x_row[kRowBlock * unroll];
      [[unroll]] for (int r = 0; r < kRowBlock; ++r) {
        int i = first + r;
        [[unroll]] for (int u = 0; u < unroll; ++u) {
          vec4 held = a[u * row_texels + i / lanes];
          uint holder = uint(i % lanes);
          x_row[r * unroll + u] =
              vec4(subgroupShuffle(held.x, holder), subgroupShuffle(held.y, holder),
                   subgroupShuffle(held.z, holder), subgroupShuffle(held.w, holder));
        }
      }
      [[unroll]] for (int j = 0; j < tile_columns; ++j) {
        [[unroll]] for (int u = 0; u < unroll; ++u) {
          vec4 w = b[u * tile_columns + j];
          [[unroll]] for (int c = 0; c < 4; ++c) {
            [[unroll]] for (int r = 0; r < kRowBlock; ++r) {
              sum[(first + r) * tile_columns + j] += x_row[r * unroll + u][c] * w[c];
            }
          }
        }
      }
    }
  }

  [[unroll]] for (int i = 0; i < tile_rows; ++i) {
    [[unroll]] for (int q = 0; q < quads; ++q) {
      int texel = (first_row + i) * push.row_quads + out_quad + q * lanes;
      vec4 value;
      [[unroll]] for (int c = 0; c < 4; ++c) {
        value[c] = sum[i * tile_columns + q * 4 + c];
        if (activation == 1) value[c] = gelu(value[c]);
      }
      if (has_residual != 0 && activation == 1) {
        value += texelFetch(residual, (first_row + i) * push.residual_quads + out_quad + q * lanes);
      }
      y[texel] = value;
    }
  }
}
