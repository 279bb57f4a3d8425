// layer_norm: y[r, :] = (x[r, :] - mean) / sqrt(var + 1e-5) * gain + shift
//
//   thesis    Sec. 3.4, pre-norm blocks
//   in        x      [rows, 256] f32, RGBA texels
//             gain   [256]       RGBA texels
//             shift  [256]       RGBA texels
//   out       y      [rows, 256] f32; not x
//   dispatch  (rows / lanes rounded up, 1, 1), one subgroup a workgroup, one lane a row; where all lanes
//             share a row (rows, 1, 1)
//   twin      engine/reference/layer_norm.cpp; agrees to 1e-5 of the largest output
//
// The variance is taken in a second pass: one pass loses three digits where |mean| >> sqrt(var). CPU
// drivers like a row a lane. A GPU's lanes share one: they read what lies side by side, hold it in a
// few registers (a whole row would take all), and add up through shared memory in a fixed order.
#version 450
#extension GL_EXT_control_flow_attributes : require

layout(constant_id = 0) const int lanes = 8;
layout(constant_id = 1) const int across = 1;  // lanes that share a row: one, or all
layout(local_size_x_id = 0) in;

layout(binding = 0) uniform samplerBuffer x;
layout(binding = 1) uniform samplerBuffer gain;
layout(binding = 2) uniform samplerBuffer shift;
layout(binding = 3, std430) writeonly buffer Y { vec4 y[]; };

const int kTexels = 64;  // a row
const int kUnroll = 4;
const float kEpsilon = 1e-5;

const int share = (kTexels + across - 1) / across;  // of a row, a lane's
const int quads = across > 1 ? (across + 3) / 4 : 1;
shared vec4 parts[quads];

/// Of all lanes' values, the same for each of them.
float sum_over_lanes(float value) {
  uint lane = gl_LocalInvocationID.x;
  barrier();
  parts[lane / 4][lane % 4] = value;
  barrier();
  vec4 sum = vec4(0.0);
  [[unroll]] for (int i = 0; i < quads; ++i) sum += parts[i];
  return (sum.x + sum.y) + (sum.z + sum.w);
}

float sum_of(vec4 value) { return (value.x + value.y) + (value.z + value.w); }

void normalize_together() {
  int base = int(gl_WorkGroupID.x) * kTexels;
  int lane = int(gl_LocalInvocationID.x);
  vec4 held[share];
  vec4 sum = vec4(0.0);
  [[unroll]] for (int i = 0; i < share; ++i) {
    int texel = i * across + lane;
    held[i] = texel < kTexels ? texelFetch(x, base + min(texel, kTexels - 1)) : vec4(0.0);
    sum += held[i];
  }
  float mean = sum_over_lanes(sum_of(sum)) / 256.0;

  vec4 square = vec4(0.0);
  [[unroll]] for (int i = 0; i < share; ++i) {
    held[i] -= mean;
    if (i * across + lane < kTexels) square += held[i] * held[i];
  }
  float variance = sum_over_lanes(sum_of(square)) / 256.0;
  float factor = 1.0 / sqrt(variance + kEpsilon);

  [[unroll]] for (int i = 0; i < share; ++i) {
    int texel = i * across + lane;
    if (texel < kTexels) {
      y[base + texel] = held[i] * factor * texelFetch(gain, texel) + texelFetch(shift, texel);
    }
  }
}

void normalize_alone() {
  // A multiple of 64 rows. Lanes past the last row (a subgroup of 128) repeat it.
  int base = min(int(gl_GlobalInvocationID.x) * kTexels, textureSize(x) - kTexels);

  vec4 sum = vec4(0.0);
  for (int c = 0; c < kTexels; c += kUnroll) {
    [[unroll]] for (int u = 0; u < kUnroll; ++u) sum += texelFetch(x, base + c + u);
  }
  float mean = ((sum.x + sum.y) + (sum.z + sum.w)) / 256.0;

  vec4 square = vec4(0.0);
  for (int c = 0; c < kTexels; c += kUnroll) {
    [[unroll]] for (int u = 0; u < kUnroll; ++u) {
      vec4 difference = texelFetch(x, base + c + u) - mean;
      square += difference * difference;
    }
  }
  float variance = ((square.x + square.y) + (square.z + square.w)) / 256.0;
  float factor = 1.0 / sqrt(variance + kEpsilon);

  for (int c = 0; c < kTexels; c += kUnroll) {
    [[unroll]] for (int u = 0; u < kUnroll; ++u) {
      vec4 centred = texelFetch(x, base + c + u) - mean;
      y[base + c + u] = centred * factor * texelFetch(gain, c + u) + texelFetch(shift, c + u);
    }
  }
}

void main() {
  if (across > 1) {
    normalize_together();
  } else {
    normalize_alone();
  }
}
