// frame_normalization: norm = (mean, root mean square distance to it) of the valid points
//
//   thesis    Eq. (3.8), (3.9), over this frame's visible points
//   in        points  [256, 4] f32, RGBA texels; column 3 above 0.5: valid
//   out       norm    [1, 4]   f32; a scale below 1e-6, or no valid point: scale 1
//   dispatch  (1, 1, 1): one subgroup; lane l adds the points l, l + lanes, ...
//   twin      engine/reference/normalization.cpp; agrees to 1e-5 relative
#version 450
#ifndef PLAIN  // without subgroups: see vulkan/shader_code.hpp
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#endif
#extension GL_EXT_control_flow_attributes : require

layout(constant_id = 0) const int lanes = 8;
layout(local_size_x_id = 0) in;

layout(binding = 0) uniform samplerBuffer points;
layout(binding = 1, std430) writeonly buffer Norm { vec4 norm[]; };

const int kPoints = 256;
const float kSmallestScale = 1e-6;

#ifdef PLAIN
shared float handed[lanes];
#endif

// The sum over all lanes, in a fixed tree, on every lane.
float all_lanes(float value) {
  for (uint step = 1; step < uint(lanes); step *= 2) {
#ifndef PLAIN
    value += subgroupShuffle(value, gl_LocalInvocationID.x ^ step);
#else
    barrier();
    handed[gl_LocalInvocationID.x] = value;
    barrier();
    value += handed[gl_LocalInvocationID.x ^ step];
#endif
  }
  return value;
}

void main() {
  int lane = int(gl_LocalInvocationID.x);
  vec4 sum = vec4(0.0);
  for (int i = lane; i < kPoints; i += lanes) {
    vec4 point = texelFetch(points, i);
    sum += point.w > 0.5 ? vec4(point.xyz, 1.0) : vec4(0.0);
  }
  float count = all_lanes(sum.w);
  vec3 mean = vec3(all_lanes(sum.x), all_lanes(sum.y), all_lanes(sum.z)) / max(count, 1.0);

  float square = 0.0;
  for (int i = lane; i < kPoints; i += lanes) {
    vec4 point = texelFetch(points, i);
    vec3 difference = point.xyz - mean;
    square += point.w > 0.5 ? dot(difference, difference) : 0.0;
  }
  float scale = sqrt(all_lanes(square) / max(count, 1.0));
  norm[0] = vec4(mean, scale < kSmallestScale ? 1.0 : scale);
}
