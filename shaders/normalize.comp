// normalize: out[r, 0:3] = (points[r, 0:3] - mean) / scale, or its inverse scale * state + mean
//
//   thesis    Eq. (3.10)
//   in        points  [rows, 4] f32, RGBA texels
//             norm    [1, 4]    (mean, scale)
//   out       result  [rows, 4] f32; column 3 is copied
//   dispatch  (rows / lanes rounded up, 1, 1), one subgroup a workgroup, one lane a row
//   twin      engine/reference/normalization.cpp; agrees to 1e-6 relative
#version 450

layout(constant_id = 0) const int lanes = 8;
layout(constant_id = 1) const int inverse_form = 0;
layout(local_size_x_id = 0) in;

layout(binding = 0) uniform samplerBuffer points;
layout(binding = 1) uniform samplerBuffer norm;
layout(binding = 2, std430) writeonly buffer Result { vec4 result[]; };

void main() {
  int row = min(int(gl_GlobalInvocationID.x), textureSize(points) - 1);
  vec4 point = texelFetch(points, row);
  vec4 mean_scale = texelFetch(norm, 0);
  vec3 moved = inverse_form != 0 ? mean_scale.w * point.xyz + mean_scale.xyz
                                 : (point.xyz - mean_scale.xyz) / mean_scale.w;
  result[row] = vec4(moved, point.w);
}
