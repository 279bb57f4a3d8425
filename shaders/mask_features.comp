// mask_features: phi_M(u_j), the local features at the projection of every row of the state
//
//   thesis    Sec. 3.4, Eq. (3.15), (3.16); spec section 6
//   in        state   [rows, 4]      f32, RGBA texels, normalised
//             norm    [1, 4]         (mean, scale)
//             params  [1, 16]        FrameParams as four RGBA texels
//             field   [capacity, 4]  RGBA texels, or a storage buffer where it has too many
//             depth   [capacity, 1]  R texels, or a storage buffer
//   out       phi     [rows, 8]      f32
//   dispatch  (rows / lanes rounded up, 1, 1), one subgroup a workgroup, one lane a row
//   twin      engine/reference/mask_features.cpp; agrees to 1e-4 (a pixel is 1/100 of a feature)
#version 450
#extension GL_GOOGLE_include_directive : require
#include "push_constants.h"

layout(constant_id = 0) const int lanes = 8;
layout(constant_id = 1) const int field_is_texels = 1;
layout(constant_id = 2) const int depth_is_texels = 1;
layout(constant_id = 3) const int has_depth = 0;
layout(local_size_x_id = 0) in;

layout(push_constant) uniform Push { MaskFeaturesPush push; };
layout(binding = 0) uniform samplerBuffer state;
layout(binding = 1) uniform samplerBuffer norm;
layout(binding = 2) uniform samplerBuffer params;
layout(binding = 3) uniform samplerBuffer field_texels;
layout(binding = 4, std430) readonly buffer Field { vec4 field_rows[]; };
layout(binding = 5) uniform samplerBuffer depth_texels;
layout(binding = 6, std430) readonly buffer Depth { float depth_rows[]; };
layout(binding = 7, std430) writeonly buffer Phi { vec4 phi[]; };

const float kNearestDepth = 0.02;    // m, feature 6
const float kFeatureWidth = 640.0;   // distances are pixels of an image this wide
const float kFeatureScale = 100.0;   // ... divided by this
const float kFeatureLimit = 3.0;     // ... and clamped
const float kResidualLimit = 0.2;    // m, Eq. (3.16)
const float kResidualNear = 0.05;    // m, Sec. 3.4, below Eq. (3.16)
const float kResidualFar = 0.5;

// a / b to the last bit, as the twin has it. Vulkan's own division may be off by 2.5 units in the last
// place: of a pixel far to the right that is a share of a texel, times whatever the field does there.
float quotient(float a, float b) {
  precise float q = a / b;
  precise float q_wide = 4097.0 * q;  // q and b as two halves each, whose products are exact
  precise float q_high = q_wide - (q_wide - q);
  precise float q_low = q - q_high;
  precise float b_wide = 4097.0 * b;
  precise float b_high = b_wide - (b_wide - b);
  precise float b_low = b - b_high;
  precise float back = q * b;
  precise float lost = ((q_high * b_high - back) + q_high * b_low + q_low * b_high) + q_low * b_low;
  precise float rest = (a - back) - lost;
  precise float nearest = q + rest / b;
  return nearest;
}

vec2 quotient(vec2 a, vec2 b) { return vec2(quotient(a.x, b.x), quotient(a.y, b.y)); }

vec4 field_at(int line, int column, int width) {
  int index = clamp(line * width + column, 0, push.field_texels - 1);
  if (field_is_texels != 0) return texelFetch(field_texels, index);
  return field_rows[index];
}

// All four channels at half-resolution position p, clamped to the field's border.
vec4 bilinear(vec2 p, vec2 size) {
  p = clamp(p, vec2(0.0), size - 1.0);
  ivec2 last = ivec2(size) - 1;
  ivec2 low = min(ivec2(p), max(last - 1, ivec2(0)));
  ivec2 high = min(low + 1, last);
  vec2 part = p - vec2(low);
  int width = last.x + 1;
  vec4 upper_left = field_at(low.y, low.x, width);
  vec4 lower_left = field_at(high.y, low.x, width);
  vec4 upper = upper_left + part.x * (field_at(low.y, high.x, width) - upper_left);
  vec4 lower = lower_left + part.x * (field_at(high.y, high.x, width) - lower_left);
  return upper + part.y * (lower - upper);
}

// (residual, validity) of Eq. (3.16).
vec2 depth_residual(vec2 u, vec2 image, float z) {
  ivec2 pixel = clamp(ivec2(floor(u + 0.5)), ivec2(0), ivec2(image) - 1);
  int index = clamp(pixel.y * int(image.x) + pixel.x, 0, push.depth_pixels - 1);
  float seen = depth_is_texels != 0 ? texelFetch(depth_texels, index).x : depth_rows[index];
  bool usable = seen >= kResidualNear && seen <= kResidualFar;
  float residual = clamp(seen - z, -kResidualLimit, kResidualLimit) / kResidualLimit;
  return usable ? vec2(residual, 1.0) : vec2(0.0);
}

void main() {
  int row = min(int(gl_GlobalInvocationID.x), textureSize(state) - 1);
  vec4 mean_scale = texelFetch(norm, 0);
  precise vec3 node = mean_scale.w * texelFetch(state, row).xyz + mean_scale.xyz;  // Eq. (3.10)
  bool in_front = node.z > kNearestDepth;
  float z = in_front ? node.z : 1.0;

  vec4 camera = texelFetch(params, 0);  // fx, fy, cx, cy
  vec4 sizes = texelFetch(params, 1);   // width, height, field_width, field_height
  precise vec2 scaled = camera.xy * node.xy;
  precise vec2 u = quotient(scaled, vec2(z)) + camera.zw;
  bool inside = u.x > -0.5 && u.x < sizes.x - 0.5 && u.y > -0.5 && u.y < sizes.y - 0.5;

  precise vec2 shifted = (u + 0.5) * sizes.zw;
  precise vec2 place = quotient(shifted, sizes.xy) - 0.5;
  vec4 read = bilinear(place, sizes.zw);
  float to_feature = kFeatureWidth / sizes.z / kFeatureScale;
  vec2 displacement = clamp(read.zw * to_feature, -kFeatureLimit, kFeatureLimit);
  float away = min(sqrt(read.z * read.z + read.w * read.w) * to_feature, kFeatureLimit);
  vec2 residual = vec2(0.0);
  if (has_depth != 0) residual = inside ? depth_residual(u, sizes.xy, z) : vec2(0.0);

  phi[2 * row] = in_front ? vec4(read.xy, away, displacement.x) : vec4(0.0);
  phi[2 * row + 1] =
      in_front ? vec4(displacement.y, inside ? 1.0 : 0.0, residual) : vec4(0.0);
}
