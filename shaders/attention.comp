// attention: out[r, 32 h ...] = softmax(q k^T / sqrt(32)) v for head h
//
//   thesis    Sec. 3.4: Eq. (3.14), and the encoder's self-attention
//   in        query      [rows, 4 query_stride]      f32, RGBA texels
//             key_value  [keys, 4 key_value_stride]  f32, RGBA texels
//             valid      [keys, 4]                   RGBA texels; column 3 below 0.5: left out
//                                                    (ones where all count, of the 64 keys of a draw)
//             key_rows, valid_rows  the same as key_value and valid, as storage buffers
//   out       result     [rows, 256]  f32
//   dispatch  (8 heads, rows / (lanes * queries) rounded up, 1), one subgroup a workgroup; rows last,
//             so that what a core of a CPU driver reads is what it wrote before
//   twin      engine/reference/attention.cpp; agrees to 1e-5 of the largest value
//
// A lane owns `queries` queries. Keys come in blocks of `block`. CPU drivers spread their texels over
// the lanes: each fetches its share, shuffles hand them round. Elsewhere, where hands_round is not
// set, all lanes read every key from one address: a GPU does that once for all of them, into scalar
// registers. The softmax is online, rescaled once a block. Nothing waits.
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
layout(constant_id = 4) const int hands_round = 1;
layout(local_size_x_id = 0) in;

layout(push_constant) uniform Push { AttentionPush push; };
layout(binding = 0) uniform samplerBuffer query;
layout(binding = 1) uniform samplerBuffer key_value;
layout(binding = 2) uniform samplerBuffer valid;
layout(binding = 3, std430) restrict writeonly buffer Result { vec4 result[]; };
layout(binding = 4, std430) restrict readonly buffer Keys { vec4 key_rows[]; };
layout(binding = 5, std430) restrict readonly buffer Valid { vec4 valid_rows[]; };

const int kHeadTexels = 8;  // 32 channels
const int kRowTexels = 64;  // of the result
const int kDrawRows = 64;
const float kScale = 0.17677669529663687;  // 1 / sqrt(32)
const float kLowest = -1e30;

// A block's texels of a head: lane l holds texel l % spread of key l / spread, then the one `spread`
// texels on, and so forth.
const int spread = lanes / block < kHeadTexels ? lanes / block : kHeadTexels;
const int share = kHeadTexels / spread;

// Texel c of key j of the block: a share of what lanes hold, or one address for all of them.
#ifndef PLAIN
vec4 from(vec4 held[share], int j, int c, uint group) {
  vec4 texel = held[c / spread];
  uint holder = group + uint(j * spread + c % spread);
  return vec4(subgroupShuffle(texel.x, holder), subgroupShuffle(texel.y, holder),
              subgroupShuffle(texel.z, holder), subgroupShuffle(texel.w, holder));
}
#define HANDED(handed, read) (hands_round != 0 ? handed : read)
#else
#define HANDED(handed, read) read
#endif
#define KEY(j, c) HANDED(from(k, j, c, group), key_rows[one_key + j * row_quads + c])
#define VALUE(j, c) HANDED(from(v, j, c, group), key_rows[one_value + j * row_quads + c])
#define USABLE(j) HANDED(subgroupShuffle(usable, group + uint(j * spread)), valid_rows[one_valid + j].w)

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
  // The same for all lanes, who are no more than a draw's rows where they read the same keys.
  uint row_quads = uint(push.key_value_stride);
  uint one_draw = min(gl_WorkGroupID.y * lanes * queries, uint(push.rows - 1)) / kDrawRows;
  uint one_row = one_draw * push.keys_a_draw * row_quads + gl_WorkGroupID.x * kHeadTexels;
  uint one_key = one_row + push.key_column;
  uint one_value = one_row + push.value_column;
  uint one_valid = one_draw * push.valid_a_draw;
  // Not a specialisation constant: one kernel, 0.2 s of a CPU driver's compiler, serves both uses.
  int keys = few_keys != 0 ? few_keys : textureSize(valid);

  for (int b = 0; b < keys; b += block) {
#ifndef PLAIN
    int mine = b + lane / spread % block;
    vec4 k[share];
    vec4 v[share];
    float usable;
    if (hands_round != 0) {
      [[unroll]] for (int c = 0; c < share; ++c) {
        int texel = texel_of(first_key + mine, head + lane % spread + c * spread);
        k[c] = texelFetch(key_value, texel + push.key_column);
        v[c] = texelFetch(key_value, texel + push.value_column);
      }
      usable = texelFetch(valid, first_valid + mine).w;
    }
#endif

    float score[queries * block];
    [[unroll]] for (int j = 0; j < block; ++j) {
      [[unroll]] for (int i = 0; i < queries; ++i) score[i * block + j] = 0.0;
      vec4 parts[queries];  // what a GPU adds up without waiting for the sum before
      [[unroll]] for (int i = 0; i < queries; ++i) parts[i] = vec4(0.0);
      [[unroll]] for (int c = 0; c < kHeadTexels; ++c) {
        vec4 key = KEY(j, c);
        [[unroll]] for (int i = 0; i < queries; ++i) {
          if (hands_round != 0) {
            score[i * block + j] += dot(q[i * kHeadTexels + c], key);
          } else {
            parts[i] += q[i * kHeadTexels + c] * key;
          }
        }
      }
      float seen = USABLE(j);
      [[unroll]] for (int i = 0; i < queries; ++i) {
        if (hands_round == 0) {
          score[i * block + j] = (parts[i].x + parts[i].y) + (parts[i].z + parts[i].w);
        }
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
    one_key += block * row_quads;
    one_value += block * row_quads;
    one_valid += block;
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
