// attention: out[r, 32 h ...] = softmax(q k^T / sqrt(32)) v for head h
//
//   thesis    Sec. 3.4: Eq. (3.14), and the encoder's self-attention
//   in        query      [rows, 4 query_stride]      f32, RGBA texels
//             key_value  [keys, 4 key_value_stride]  f32, RGBA texels
//             valid      [keys, 4]                   RGBA texels; column 3 below 0.5: left out
//                                                    (ones where all count, of the 64 keys of a draw)
//   out       result     [rows, 256]  f32
//   dispatch  (8 heads, rows / (lanes * queries) rounded up, 1), one subgroup a workgroup; rows last,
//             so that what a core of a CPU driver reads is what it wrote before
//   twin      engine/reference/attention.cpp; agrees to 1e-5 of the largest value
//
// A lane owns `queries` queries. Keys come in blocks of `block`, whose texels are spread over the
// lanes: each fetches its share, shuffles hand them round; a plain kernel's lanes all fetch every
// texel, from one address. The softmax is online, rescaled once a block. Nothing waits.
#version 450
#extension GL_GOOGLE_include_directive : require
#ifndef PLAIN  // without subgroups: see vulkan/shader_code.hpp
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#endif
#extension GL_EXT_control_flow_attributes : require
#include "push_constants.h"

layout(constant_id = 0) const int lanes = 8;
layout(constant_id = 1) const int queries = 4;   // a lane; lanes * queries at most 64, or 1
layout(constant_id = 2) const int block = 4;     // keys; divides `lanes`
layout(constant_id = 3) const int few_keys = 0;  // that a row sees; 0: all of `valid`
layout(local_size_x_id = 0) in;

layout(push_constant) uniform Push { AttentionPush push; };
layout(binding = 0) uniform samplerBuffer query;
layout(binding = 1) uniform samplerBuffer key_value;
layout(binding = 2) uniform samplerBuffer valid;
layout(binding = 3, std430) writeonly buffer Result { vec4 result[]; };

const int kHeadTexels = 8;  // 32 channels
const int kRowTexels = 64;  // of the result
const int kDrawRows = 64;
const float kScale = 0.17677669529663687;  // 1 / sqrt(32)
const float kLowest = -1e30;

// A block's texels of a head: lane l holds texel l % spread of key l / spread, then the one `spread`
// texels on, and so forth.
const int spread = lanes / block < kHeadTexels ? lanes / block : kHeadTexels;
const int share = kHeadTexels / spread;

// Texel c of key j of the block.
#ifndef PLAIN
vec4 from(vec4 held[share], int j, int c, uint group) {
  vec4 texel = held[c / spread];
  uint holder = group + uint(j * spread + c % spread);
  return vec4(subgroupShuffle(texel.x, holder), subgroupShuffle(texel.y, holder),
              subgroupShuffle(texel.z, holder), subgroupShuffle(texel.w, holder));
}
#define KEY(j, c) from(k, j, c, group)
#define VALUE(j, c) from(v, j, c, group)
#define USABLE(j) subgroupShuffle(usable, group + uint(j * spread))
#else
#define KEY(j, c) texelFetch(key_value, texel_of(first_key + b + j, head + c) + push.key_column)
#define VALUE(j, c) texelFetch(key_value, texel_of(first_key + b + j, head + c) + push.value_column)
#define USABLE(j) texelFetch(valid, first_valid + b + j).w
#endif

int texel_of(int key, int column) { return key * push.key_value_stride + column; }

void main() {
  int lane = int(gl_LocalInvocationID.x);
  int head = int(gl_WorkGroupID.x) * kHeadTexels;
  int first_row = int(gl_WorkGroupID.y) * lanes * queries + lane;
  // A subgroup of 128 spans two draws: each half takes its keys from lanes of its own half.
  uint group = lanes > kDrawRows ? uint(lane / kDrawRows * kDrawRows) : 0u;

  vec4 q[queries * kHeadTexels];
  vec4 total[queries * kHeadTexels];
  float highest[queries];
  float weight_sum[queries];
  [[unroll]] for (int i = 0; i < queries; ++i) {
    int row = min(first_row + i * lanes, push.rows - 1);
    [[unroll]] for (int c = 0; c < kHeadTexels; ++c) {
      int texel = row * push.query_stride + push.query_column + head + c;
      q[i * kHeadTexels + c] = texelFetch(query, texel) * kScale;
      total[i * kHeadTexels + c] = vec4(0.0);
    }
    highest[i] = kLowest;
    weight_sum[i] = 0.0;
  }
  int draw = min(first_row, push.rows - 1) / kDrawRows;
  int first_key = draw * push.keys_a_draw;
  int first_valid = draw * push.valid_a_draw;
  // Not a specialisation constant: one kernel, 0.2 s of a CPU driver's compiler, serves both uses.
  int keys = few_keys != 0 ? few_keys : textureSize(valid);

  for (int b = 0; b < keys; b += block) {
#ifndef PLAIN
    int mine = b + lane / spread % block;
    vec4 k[share];
    vec4 v[share];
    [[unroll]] for (int c = 0; c < share; ++c) {
      int texel = texel_of(first_key + mine, head + lane % spread + c * spread);
      k[c] = texelFetch(key_value, texel + push.key_column);
      v[c] = texelFetch(key_value, texel + push.value_column);
    }
    float usable = texelFetch(valid, first_valid + mine).w;
#endif

    float score[queries * block];
    [[unroll]] for (int j = 0; j < block; ++j) {
      [[unroll]] for (int i = 0; i < queries; ++i) score[i * block + j] = 0.0;
      [[unroll]] for (int c = 0; c < kHeadTexels; ++c) {
        vec4 key = KEY(j, c);
        [[unroll]] for (int i = 0; i < queries; ++i) {
          score[i * block + j] += dot(q[i * kHeadTexels + c], key);
        }
      }
      float seen = USABLE(j);
      [[unroll]] for (int i = 0; i < queries; ++i) {
        score[i * block + j] = seen < 0.5 ? kLowest : score[i * block + j];
      }
    }

    [[unroll]] for (int i = 0; i < queries; ++i) {
      float top = highest[i];
      [[unroll]] for (int j = 0; j < block; ++j) top = max(top, score[i * block + j]);
      float shrink = exp(highest[i] - top);
      highest[i] = top;
      weight_sum[i] *= shrink;
      [[unroll]] for (int c = 0; c < kHeadTexels; ++c) total[i * kHeadTexels + c] *= shrink;
      [[unroll]] for (int j = 0; j < block; ++j) {
        float weight = exp(score[i * block + j] - top);
        weight = score[i * block + j] > 0.5 * kLowest ? weight : 0.0;
        score[i * block + j] = weight;
        weight_sum[i] += weight;
      }
    }
    // Texel by texel: what is summed up stays in registers for all keys of the block.
    [[unroll]] for (int c = 0; c < kHeadTexels; ++c) {
      [[unroll]] for (int j = 0; j < block; ++j) {
        vec4 value = VALUE(j, c);
        [[unroll]] for (int i = 0; i < queries; ++i) {
          total[i * kHeadTexels + c] += score[i * block + j] * value;
        }
      }
    }
  }

  [[unroll]] for (int i = 0; i < queries; ++i) {
    int row = first_row + i * lanes;
    float factor = weight_sum[i] > 0.0 ? 1.0 / weight_sum[i] : 0.0;  // no key left: zero
    if (lanes <= kDrawRows || row < push.rows) {
      [[unroll]] for (int c = 0; c < kHeadTexels; ++c) {
        result[row * kRowTexels + head + c] = total[i * kHeadTexels + c] * factor;
      }
    }
  }
}
