// Push constants of every kernel, one struct each; included by C++ and GLSL. Offsets, strides and
// floats only: what decides a branch or bounds a loop is a specialisation constant, since lavapipe
// 22.3 compiles a shader anew at every dispatch whose push constants do so.
#ifndef FLOWDLO_SHADERS_PUSH_CONSTANTS_H
#define FLOWDLO_SHADERS_PUSH_CONSTANTS_H

#ifdef __cplusplus
namespace flowdlo::vulkan {
#endif

struct GemmPush {
  int row_quads;       // from a row of y to the next, in fours of columns
  int residual_quads;  // the same of residual
  int first_quad;      // of this dispatch; a multiple of 64
};

struct TileGemmPush {  // also of matrix_gemm
  int rows;            // of x and y in this dispatch
  int row_quads;       // columns of y and residual, in fours
};

struct NarrowPush {
  int first_row;     // of x in this dispatch
  int first_period;  // Addend::period; Addend::offset less the first bound row of the table
  int first_offset;
  int second_period;
  int second_offset;
};

struct AttentionPush {
  int rows;
  int query_stride;  // in texels of four channels, like the next four
  int query_column;
  int key_value_stride;
  int key_column;
  int value_column;
  int keys_a_draw;   // rows from one draw's keys to the next's; 0: all draws see the same
  int valid_a_draw;  // the same of `valid`
};

struct FarthestPush {
  int capacity;  // rows of the cloud
  int row;       // of `visible` that receives the pick
};

struct MaskFeaturesPush {
  int field_texels;  // rows of the field
  int depth_pixels;  // rows of the depth image
};

struct ConvolutionPush {
  int side_bits;   // a block's side is 1 << side_bits
  int fours;       // of places in this dispatch
  int x_quads;     // from a place of x to the next, in fours of channels
  int y_quads;     // the same of y
  int first_quad;  // of y in this dispatch
  float least;     // that a result may be: 0 makes a ReLU
};

struct FlowStepPush {
  float t;
  float dt;
  float prior_sd;  // s of spec section 6
};

#ifdef __cplusplus
}  // namespace flowdlo::vulkan
#endif

#endif  // FLOWDLO_SHADERS_PUSH_CONSTANTS_H
