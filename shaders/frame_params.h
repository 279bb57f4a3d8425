// FrameParams: what changes from frame to frame. One [1, 16] f32 tensor; included by C++ and GLSL.
#ifndef FLOWDLO_SHADERS_FRAME_PARAMS_H
#define FLOWDLO_SHADERS_FRAME_PARAMS_H

#ifdef __cplusplus
namespace flowdlo::ops {
#endif

struct FrameParams {
  float fx;  // pixels
  float fy;
  float cx;
  float cy;
  float width;  // of the image, pixels
  float height;
  float field_width;  // of the mask field, half-resolution pixels
  float field_height;
  float point_count;  // rows of the cloud in use; exact up to 2^24
  float centroid_x;   // of the cloud, metres
  float centroid_y;
  float centroid_z;
  float reserved0;
  float reserved1;
  float reserved2;
  float reserved3;
};

#ifdef __cplusplus
static_assert(sizeof(FrameParams) == 64, "FrameParams is one [1, 16] f32 tensor");
}  // namespace flowdlo::ops
#endif

#endif  // FLOWDLO_SHADERS_FRAME_PARAMS_H
