// max_pool: y[p, :] = the largest of each 2 x 2 places of x, over an image in blocks
//
//   thesis    -
//   in        x       [blocks * side^2, channels]        f32, as RGBA texels; a storage buffer
//                                                        where x_is_texels is not set
//             map     [blocks, 12]                       as single texels
//   out       y       [blocks * (side / 2)^2, channels]  f32
//   dispatch  (blocks, texels of a block of y / (lanes * 8) rounded up, 1), one subgroup each
//   twin      engine/reference/block_image.cpp; the same bits
#version 450
#extension GL_GOOGLE_include_directive : require
#include "block_image.glsl"

layout(constant_id = 0) const int lanes = 8;
layout(constant_id = 1) const int side = 16;  // of x
layout(constant_id = 2) const int quads = 4;  // of channels
layout(constant_id = 3) const int x_is_texels = 1;
layout(local_size_x_id = 0) in;

layout(binding = 0) uniform samplerBuffer x_texels;
layout(binding = 1, std430) readonly buffer X { vec4 x[]; };
layout(binding = 2) uniform samplerBuffer map;
layout(binding = 3, std430) writeonly buffer Y { vec4 y[]; };

const int kTexelsOfLane = 8;
const int half_side = side / 2;
const int texels = half_side * half_side * quads;  // of a block of y

vec4 input_at(int texel) {
  return x_is_texels != 0 ? texelFetch(x_texels, texel) : x[texel];
}

void main() {
  int block = int(gl_WorkGroupID.x);
  if (texelFetch(map, block * kMapEntries + kOwn).x < 0.0) return;
  for (int i = 0; i < kTexelsOfLane; ++i) {
    int texel = (int(gl_WorkGroupID.y) * kTexelsOfLane + i) * lanes + int(gl_LocalInvocationID.x);
    texel = min(texel, texels - 1);  // the last may be done twice
    int place = texel / quads;
    int above = (block * half_side + place / half_side) * 2 * side + place % half_side * 2;
    int from = above * quads + texel % quads;
    int below = from + side * quads;
    vec4 upper = max(input_at(from), input_at(from + quads));
    vec4 lower = max(input_at(below), input_at(below + quads));
    y[block * texels + texel] = max(upper, lower);
  }
}
