// narrow: y[r, :] = act(x[r, 0:inputs] W^T + bias) + first[r] + second[r]
//
//   thesis    Sec. 3.4: E_x, E_prior, E_h, the first layers of E_obs and E_loc
//   in        x       [rows, 4 or 8]  f32, RGBA texels; channels from `inputs` on are not looked at
//             weight  [256, 8]        RGBA texels, zero from `inputs` on
//             bias    [256]           RGBA texels
//             first, second [any, 256] RGBA texels; row r takes table[r % period + offset]
//   out       y       [rows, 256]     f32
//   dispatch  (64 / lanes rounded up, rows / 16, 1), one subgroup a workgroup; a lane owns four
//             columns of sixteen rows
//   twin      engine/reference/narrow.cpp; agrees to 1e-5 of the largest output
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "activation.glsl"
#include "push_constants.h"

layout(constant_id = 0) const int lanes = 8;
layout(constant_id = 1) const int x_texels = 1;  // a row of x: one or two
layout(constant_id = 2) const int inputs = 3;
layout(constant_id = 3) const int activation = 0;
layout(constant_id = 4) const int addends = 0;   // 0, 1 or 2
layout(local_size_x_id = 0) in;

layout(push_constant) uniform Push { NarrowPush push; };
layout(binding = 0) uniform samplerBuffer x;
layout(binding = 1) uniform samplerBuffer weight;
layout(binding = 2) uniform samplerBuffer bias;
layout(binding = 3) uniform samplerBuffer first;
layout(binding = 4) uniform samplerBuffer second;
layout(binding = 5, std430) writeonly buffer Y { vec4 y[]; };

const int kRows = 16;
const int kTexelsOfRow = 64;  // of y

vec4 known(vec4 texel, int first_channel) {
  [[unroll]] for (int c = 0; c < 4; ++c) {
    if (first_channel + c >= inputs) texel[c] = 0.0;
  }
  return texel;
}

void main() {
  // Lanes past the row's end repeat its last texel: the same value to the same place.
  int texel = min(int(gl_GlobalInvocationID.x), kTexelsOfRow - 1);
  vec4 w[4 * x_texels];
  [[unroll]] for (int c = 0; c < 4; ++c) {
    [[unroll]] for (int h = 0; h < x_texels; ++h) {
      w[c * x_texels + h] = texelFetch(weight, (texel * 4 + c) * 2 + h);
    }
  }
  vec4 start = texelFetch(bias, texel);

  for (int i = 0; i < kRows; ++i) {
    int row = int(gl_WorkGroupID.y) * kRows + i;
    vec4 value = start;
    [[unroll]] for (int h = 0; h < x_texels; ++h) {
      vec4 seen = known(texelFetch(x, row * x_texels + h), 4 * h);
      [[unroll]] for (int c = 0; c < 4; ++c) value[c] += dot(seen, w[c * x_texels + h]);
    }
    if (activation == 1) {
      [[unroll]] for (int c = 0; c < 4; ++c) value[c] = gelu(value[c]);
    }
    if (addends > 0) {
      int added = (push.first_row + row) % push.first_period + push.first_offset;
      value += texelFetch(first, added * kTexelsOfRow + texel);
    }
    if (addends > 1) {
      int added = (push.first_row + row) % push.second_period + push.second_offset;
      value += texelFetch(second, added * kTexelsOfRow + texel);
    }
    y[row * kTexelsOfRow + texel] = value;
  }
}
