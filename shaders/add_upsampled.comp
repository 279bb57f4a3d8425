// add_upsampled: y[p, :] += x[p / 2, :], each place of x over 2 x 2 of y, an image in blocks
//
//   thesis    -
//   in        x       [blocks * (side / 2)^2, channels]  f32, as RGBA texels
//             map     [blocks, 12]                       as single texels
//   in, out   y       [blocks * side^2, channels]        f32; read as RGBA texels
//             both are read as storage buffers where they_are_texels is not set
//   dispatch  (blocks, texels of a block of y / (lanes * 8) rounded up, 1), one subgroup each
//   twin      engine/reference/block_image.cpp; the same bits
#version 450
#extension GL_GOOGLE_include_directive : require
#include "block_image.glsl"

layout(constant_id = 0) const int lanes = 8;
layout(constant_id = 1) const int side = 16;  // of y
layout(constant_id = 2) const int quads = 4;  // of channels
layout(constant_id = 3) const int they_are_texels = 1;
layout(local_size_x_id = 0) in;

layout(binding = 0) uniform samplerBuffer x_texels;
layout(binding = 1, std430) readonly buffer X { vec4 x[]; };
layout(binding = 2) uniform samplerBuffer map;
layout(binding = 3) uniform samplerBuffer y_texels;
layout(binding = 4, std430) buffer Y { vec4 y[]; };

const int kTexelsOfLane = 8;
const int half_side = side / 2;
const int texels = side * side * quads;  // of a block of y

void main() {
  int block = int(gl_WorkGroupID.x);
  if (texelFetch(map, block * kMapEntries + kOwn).x < 0.0) return;
  for (int i = 0; i < kTexelsOfLane; ++i) {
    int texel = (int(gl_WorkGroupID.y) * kTexelsOfLane + i) * lanes + int(gl_LocalInvocationID.x);
    if (texel >= texels) break;  // nothing may be added twice
    int place = texel / quads;
    int over = (block * half_side + place / side / 2) * half_side + place % side / 2;
    int from = over * quads + texel % quads;
    int to = block * texels + texel;
    if (they_are_texels != 0) {
      y[to] = texelFetch(y_texels, to) + texelFetch(x_texels, from);
    } else {
      y[to] += x[from];
    }
  }
}
