// farthest_setup: what farthest_points needs to know of this frame's number of points
//
//   thesis    Sec. 3.2
//   in        cloud    [capacity, 4] storage buffer
//             params   [1, 16]       FrameParams as four RGBA texels
//   out       visible  [256, 4]      where at most 256 points: all, then repeated with validity 0
//             groups   VkDispatchIndirectCommand of every pass of farthest_points: a workgroup for
//                      each `share` points, none where at most 256 points
//   dispatch  (256 / lanes, 1, 1), one subgroup a workgroup, one lane a row of `visible`
//   twin      engine/reference/farthest_points.cpp; equal bit for bit
#version 450
#extension GL_GOOGLE_include_directive : require
#include "push_constants.h"

layout(constant_id = 0) const int lanes = 8;
layout(constant_id = 1) const int share = 2048;  // points a workgroup of farthest_points
layout(local_size_x_id = 0) in;

layout(push_constant) uniform Push { FarthestPush push; };
layout(binding = 0, std430) readonly buffer Cloud { vec4 cloud[]; };
layout(binding = 1) uniform samplerBuffer params;
layout(binding = 2, std430) writeonly buffer Visible { vec4 visible[]; };
layout(binding = 3, std430) writeonly buffer Groups { uint groups[]; };

const int kPicks = 256;

void main() {
  int row = int(gl_GlobalInvocationID.x);
  int count = clamp(int(texelFetch(params, 2).x), 0, push.capacity);
  if (count <= kPicks) {
    vec3 point = count > 0 ? cloud[row % max(count, 1)].xyz : vec3(0.0);
    visible[row] = vec4(point, row < count ? 1.0 : 0.0);
  }
  if (row == 0) {
    groups[0] = count > kPicks ? uint((count + share - 1) / share) : 0u;
    groups[1] = 1u;
    groups[2] = 1u;
  }
}
