// convolution: y[p, :] = max(sum over taps W_tap x[p + tap, :] + bias, least), an image in blocks
//
//   thesis    -
//   in        x         [blocks * side^2, in]   f32, as RGBA texels; a storage buffer where
//                                               x_is_texels is not set. Zeros beyond the image
//             map       [blocks, 12]            of this dispatch's blocks, as single texels
//             weight    [out/16][D][in/4][D][16]  f32, as RGBA texels: four consecutive inputs of
//                                               one output; D taps down, D across. A storage buffer
//                                               where hands_round is not set
//             bias      [out]                   f32, as RGBA texels
//   out       y         [blocks * side^2, out]  f32
//   dispatch  (blocks * side^2 / (4 lanes) rounded up, outputs / 16, 1), one subgroup a workgroup
//   twin      engine/reference/convolution.cpp; agrees to 1e-5 of the largest output
//
// A lane owns 16 outputs of four places side by side, whose inputs serve all taps of a row. The
// weights are the same for all lanes: CPU drivers fetch one a lane and hand it round by shuffles
// with a constant lane; others read all from an address that all lanes share. The number of inputs
// is read from the weights' size, so that one kernel serves every layer: CPU drivers compile long.
#version 450
#extension GL_GOOGLE_include_directive : require
#ifndef PLAIN  // without subgroups: see vulkan/shader_code.hpp
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#endif
#extension GL_EXT_control_flow_attributes : require
#include "block_image.glsl"
#include "push_constants.h"

layout(constant_id = 0) const int lanes = 8;
layout(constant_id = 1) const int taps_across = 3;  // and down: 3 or 1
layout(constant_id = 2) const int x_is_texels = 1;
layout(constant_id = 3) const int hands_round = 1;
layout(local_size_x_id = 0) in;

layout(push_constant) uniform Push { ConvolutionPush push; };
layout(binding = 0) uniform samplerBuffer x_texels;
layout(binding = 1, std430) readonly buffer X { vec4 x[]; };
layout(binding = 2) uniform samplerBuffer map;
layout(binding = 3) uniform samplerBuffer weight_texels;
layout(binding = 4, std430) readonly buffer Weight { vec4 weight[]; };
layout(binding = 5) uniform samplerBuffer bias;
layout(binding = 6, std430) writeonly buffer Y { vec4 y[]; };

const int kPlaces = 4;     // of a lane, side by side
const int kPlaceBits = 2;  // kPlaces is 1 << kPlaceBits
const int kOutputs = 16;   // of a lane
const int reach = taps_across / 2;
const int columns = kPlaces + 2 * reach;            // of inputs that a row of taps sees
const int weights = taps_across * kOutputs;         // texels of a row of taps, of four inputs
const int held_texels = (weights + lanes - 1) / lanes;  // a lane's share of them

vec4 input_at(int texel) {
  return x_is_texels != 0 ? texelFetch(x_texels, texel) : x[texel];
}

/// The first input of a place in one of the three blocks beside each other, or -1.
int place_at(bool used, int row, int across, int line, int column) {
  int other = used ? int(texelFetch(map, row + across).x) : -1;
  int place = (((other << push.side_bits) + line) << push.side_bits) + column;
  return other < 0 ? -1 : place * push.x_quads;
}

void main() {
  int side = 1 << push.side_bits;
  int block_bits = 2 * push.side_bits - kPlaceBits;  // of fours of places in a block
  int first_block = (int(gl_WorkGroupID.x) * lanes) >> block_bits;
  if (texelFetch(map, first_block * kMapEntries + kOwn).x < 0.0) return;  // so are all after it

  int four = min(int(gl_GlobalInvocationID.x), push.fours - 1);  // the last may be done twice
  int block = four >> block_bits;
  bool used = texelFetch(map, block * kMapEntries + kOwn).x >= 0.0;
  int u = (four << kPlaceBits) & (side - 1);
  int v = ((four << kPlaceBits) >> push.side_bits) & (side - 1);
  int group = int(gl_WorkGroupID.y);
  int quads =
      textureSize(weight_texels) / (int(gl_NumWorkGroups.y) * kOutputs * taps_across * taps_across);

  float sum[kPlaces * kOutputs];
  [[unroll]] for (int q = 0; q < kOutputs / 4; ++q) {
    vec4 start = texelFetch(bias, push.first_quad + group * (kOutputs / 4) + q);
    [[unroll]] for (int c = 0; c < 4; ++c) {
      [[unroll]] for (int p = 0; p < kPlaces; ++p) sum[(q * 4 + c) * kPlaces + p] = start[c];
    }
  }

  int next_weight = group * (quads * weights * taps_across);
  for (int down = -reach; down <= reach; ++down) {
    int row = v + down;
    int line = row & (side - 1);
    int beside = block * kMapEntries + (row < 0 ? 0 : row < side ? 3 : 6);
    int centre = place_at(used, beside, 1, line, u);
    int left = reach == 0 ? -1 : place_at(used, beside, u == 0 ? 0 : 1, line, (u - 1) & (side - 1));
    int right = reach == 0 ? -1
                           : place_at(used, beside, u + kPlaces == side ? 2 : 1, line,
                                      (u + kPlaces) & (side - 1));
    for (int quad = 0; quad < quads; ++quad) {
      vec4 seen[columns];
      [[unroll]] for (int p = 0; p < kPlaces; ++p) {
        vec4 texel = input_at(max(centre, 0) + p * push.x_quads + quad);
        seen[p + reach] = centre < 0 ? vec4(0) : texel;
      }
      if (reach > 0) {
        vec4 before = input_at(max(left, 0) + quad);
        vec4 after = input_at(max(right, 0) + quad);
        seen[0] = left < 0 ? vec4(0) : before;
        seen[columns - 1] = right < 0 ? vec4(0) : after;
      }
#ifndef PLAIN
      vec4 held[held_texels];
      if (hands_round != 0) {
        [[unroll]] for (int f = 0; f < held_texels; ++f) {
          int mine = min(f * lanes + int(gl_SubgroupInvocationID), weights - 1);
          held[f] = texelFetch(weight_texels, next_weight + mine);
        }
      }
#endif
      [[unroll]] for (int j = 0; j < kOutputs; ++j) {
        [[unroll]] for (int t = 0; t < taps_across; ++t) {
          int of = t * kOutputs + j;
          vec4 w;
#ifndef PLAIN
          if (hands_round != 0) {
            vec4 texel = held[of / lanes];
            uint holder = uint(of % lanes);
            w = vec4(subgroupShuffle(texel.x, holder), subgroupShuffle(texel.y, holder),
                     subgroupShuffle(texel.z, holder), subgroupShuffle(texel.w, holder));
          } else
#endif
          {
            w = weight[next_weight + of];
          }
          [[unroll]] for (int c = 0; c < 4; ++c) {
            [[unroll]] for (int p = 0; p < kPlaces; ++p) {
              sum[j * kPlaces + p] += seen[p + t][c] * w[c];
            }
          }
        }
      }
      next_weight += weights;
    }
  }

  if (!used) return;
  int texel = (four << kPlaceBits) * push.y_quads + push.first_quad + group * (kOutputs / 4);
  [[unroll]] for (int p = 0; p < kPlaces; ++p) {
    [[unroll]] for (int q = 0; q < kOutputs / 4; ++q) {
      vec4 value;
      [[unroll]] for (int c = 0; c < 4; ++c) value[c] = sum[(q * 4 + c) * kPlaces + p];
      y[texel + p * push.y_quads + q] = max(value, vec4(push.least));
    }
  }
}
