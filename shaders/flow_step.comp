// flow_step: o = hidden W^T + b; state += dt * velocity(o); state[:, 3] = o[3]
//
//   thesis    Eq. (3.26)-(3.29); the preconditioned form is spec section 6
//   in        hidden  [rows, 256]   f32, RGBA texels
//             weight  [4, 256]      RGBA texels, rows past the head's channels zero
//             bias    [4]           RGBA texel
//             prior   [rows, 4]     RGBA texels, normalised
//   in, out   state   [rows, 4]     f32
//   dispatch  (rows / lanes rounded up, 1, 1), one subgroup a workgroup, one lane a row
//   twin      engine/reference/flow_step.cpp; agrees to 1e-5
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "push_constants.h"

layout(constant_id = 0) const int lanes = 8;
layout(constant_id = 1) const int parameterization = 0;  // ops::Parameterization
layout(constant_id = 2) const int channels = 3;          // 4: the fourth is log-sigma
layout(local_size_x_id = 0) in;

layout(push_constant) uniform Push { FlowStepPush push; };
layout(binding = 0) uniform samplerBuffer hidden;
layout(binding = 1) uniform samplerBuffer weight;
layout(binding = 2) uniform samplerBuffer bias;
layout(binding = 3) uniform samplerBuffer prior;
layout(binding = 4, std430) buffer State { vec4 state[]; };

const int kTexels = 64;  // a row of `hidden`
const float kEpsilon = 1e-6;

vec3 velocity(vec3 o, vec3 x, vec3 p) {
  float t = push.t;
  if (parameterization == 1) return (o - x) / max(1.0 - t, kEpsilon);  // Eq. (3.29)
  if (parameterization == 2) {
    float s = push.prior_sd;
    float den = t * t * s * s + (1.0 - t) * (1.0 - t);
    return p + (t * s * s - (1.0 - t)) / den * (x - t * p) + s / sqrt(den) * o;
  }
  return o;  // Eq. (3.27)
}

void main() {
  int row = int(gl_GlobalInvocationID.x);
  if (row >= textureSize(prior)) return;
  vec4 o = texelFetch(bias, 0);
  for (int k = 0; k < kTexels; ++k) {
    vec4 h = texelFetch(hidden, row * kTexels + k);
    [[unroll]] for (int c = 0; c < channels; ++c) {
      o[c] += dot(h, texelFetch(weight, c * kTexels + k));
    }
  }
  vec3 x = state[row].xyz;
  x += push.dt * velocity(o.xyz, x, texelFetch(prior, row).xyz);  // Eq. (3.28)
  state[row] = vec4(x, channels == 4 ? o.w : 0.0);
}
