// layer_norm: y[r, :] = (x[r, :] - mean) / sqrt(var + 1e-5) * gain + shift
//
//   thesis    Sec. 3.4, pre-norm blocks
//   in        x      [rows, 256] f32, RGBA texels
//             gain   [256]       RGBA texels
//             shift  [256]       RGBA texels
//   out       y      [rows, 256] f32; not x
//   dispatch  (rows / lanes rounded up, 1, 1), one subgroup a workgroup, one lane a row
//   twin      engine/reference/layer_norm.cpp; agrees to 1e-5 of the largest output
//
// The variance is taken in a second pass: one pass loses three digits where |mean| >> sqrt(var).
#version 450
#extension GL_EXT_control_flow_attributes : require

layout(constant_id = 0) const int lanes = 8;
layout(local_size_x_id = 0) in;

layout(binding = 0) uniform samplerBuffer x;
layout(binding = 1) uniform samplerBuffer gain;
layout(binding = 2) uniform samplerBuffer shift;
layout(binding = 3, std430) writeonly buffer Y { vec4 y[]; };

const int kTexels = 64;  // a row
const int kUnroll = 4;
const float kEpsilon = 1e-5;

void main() {
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
