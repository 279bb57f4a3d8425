// farthest_points: one pass of farthest-point sampling over the cloud
//
//   thesis    Sec. 3.2
//   in        cloud     [capacity, 4]  RGBA texels, or a storage buffer where it has too many
//             params    [1, 16]        FrameParams as four RGBA texels
//             previous  [groups, 4]    (point, distance) of each workgroup's farthest, last pass
//   in, out   nearest   [capacity]     squared distance to the picks so far
//   out       farthest  [groups, 4]    (point, distance) of each workgroup's farthest, this pass
//             visible   [256, 4]       row push.row is the pick that the last pass found
//   dispatch  indirect, one subgroup a workgroup (of a plain kernel: a workgroup of that many
//             lanes), `share` consecutive points each
//   twin      engine/reference/farthest_points.cpp; equal bit for bit
//
// The first pass measures from the centroid and only finds its farthest point. Every later pass
// first reduces the last one's partial maxima, each workgroup for itself and in the same order,
// then moves on. Workgroups are in order of their points, so ties go to the lower index throughout.
// A lane's loops: share / lanes + groups / lanes turns, far below lavapipe's 65,535; see the host.
#version 450
#extension GL_GOOGLE_include_directive : require
#ifndef PLAIN  // without subgroups: see vulkan/shader_code.hpp
#extension GL_KHR_shader_subgroup_basic : require
#extension GL_KHR_shader_subgroup_shuffle : require
#endif
#extension GL_EXT_control_flow_attributes : require
#include "push_constants.h"

layout(constant_id = 0) const int lanes = 8;
layout(constant_id = 1) const int share = 2048;
layout(constant_id = 2) const int first_pass = 0;
layout(constant_id = 3) const int cloud_is_texels = 1;
layout(local_size_x_id = 0) in;

layout(push_constant) uniform Push { FarthestPush push; };
layout(binding = 0) uniform samplerBuffer cloud_texels;
layout(binding = 1, std430) readonly buffer Cloud { vec4 cloud_rows[]; };
layout(binding = 2) uniform samplerBuffer params;
layout(binding = 3) uniform samplerBuffer previous;
layout(binding = 4) uniform samplerBuffer nearest_texels;
layout(binding = 5, std430) buffer Nearest { float nearest[]; };
layout(binding = 6, std430) writeonly buffer Farthest { vec4 farthest[]; };
layout(binding = 7, std430) writeonly buffer Visible { vec4 visible[]; };

const float kUnseen = 3.0e38;
const int kUnroll = 4;

vec4 cloud_at(int index) {
  if (cloud_is_texels != 0) return texelFetch(cloud_texels, index);
  return cloud_rows[index];
}

float nearest_at(int index) {
  if (cloud_is_texels != 0) return texelFetch(nearest_texels, index).x;
  return nearest[index];
}

#ifdef PLAIN
shared float handed[lanes];
shared int handed_index[lanes];
#endif

// The largest value over all lanes, the lowest index of equals.
void over_lanes(inout float value, inout int index) {
  for (uint step = 1; step < uint(lanes); step *= 2) {
#ifndef PLAIN
    float other = subgroupShuffle(value, gl_LocalInvocationID.x ^ step);
    int other_index = subgroupShuffle(index, gl_LocalInvocationID.x ^ step);
#else
    barrier();
    handed[gl_LocalInvocationID.x] = value;
    handed_index[gl_LocalInvocationID.x] = index;
    barrier();
    float other = handed[gl_LocalInvocationID.x ^ step];
    int other_index = handed_index[gl_LocalInvocationID.x ^ step];
#endif
    bool take = other > value || (other == value && other_index < index);
    value = take ? other : value;
    index = take ? other_index : index;
  }
}

vec3 pick_of_last_pass() {
  int groups = int(gl_NumWorkGroups.x);
  float best = -1.0;
  int winner = 0;
  for (int base = 0; base < groups; base += lanes) {
    int group = base + int(gl_LocalInvocationID.x);
    float distance = texelFetch(previous, min(group, groups - 1)).w;
    bool take = group < groups && distance > best;
    best = take ? distance : best;
    winner = take ? group : winner;
  }
  over_lanes(best, winner);
  return texelFetch(previous, winner).xyz;
}

float distance_squared(vec3 a, vec3 b) {
  precise float dx = a.x - b.x;
  precise float dy = a.y - b.y;
  precise float dz = a.z - b.z;
  precise float sum = (dx * dx + dy * dy) + dz * dz;
  return sum;
}

void main() {
  int lane = int(gl_LocalInvocationID.x);
  int first = int(gl_WorkGroupID.x) * share + lane;
  vec4 counted = texelFetch(params, 2);  // point_count, centroid
  int count = clamp(int(counted.x), 1, push.capacity);
  vec3 from = counted.yzw;
  if (first_pass == 0) {
    from = pick_of_last_pass();
    if (gl_GlobalInvocationID.x == 0) visible[push.row] = vec4(from, 1.0);
  }

  float best = -1.0;
  int winner = first;
  for (int base = 0; base < share; base += kUnroll * lanes) {
    [[unroll]] for (int u = 0; u < kUnroll; ++u) {
      // Lanes past the end repeat the last point: the same values to the same place.
      int index = min(first + base + u * lanes, count - 1);
      float distance = distance_squared(cloud_at(index).xyz, from);
      float reached = distance;
      if (first_pass == 0) {
        float before = nearest_at(index);
        reached = distance < before ? distance : before;
        nearest[index] = reached;
      } else {
        nearest[index] = kUnseen;
      }
      bool take = reached > best;
      best = take ? reached : best;
      winner = take ? index : winner;
    }
  }
  over_lanes(best, winner);
  if (lane == 0) farthest[gl_WorkGroupID.x] = vec4(cloud_at(winner).xyz, best);
}
