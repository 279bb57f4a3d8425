// Recorders: each operation of ops::Program as steps of a plan. One function a file, named after
// its kernel.
#pragma once

#include "ops/program.hpp"
#include "vulkan/convolution_layer.hpp"
#include "vulkan/dense_layer.hpp"
#include "vulkan/plan.hpp"

namespace flowdlo::vulkan {

void record_linear(Plan& plan, const ops::Linear& op, const DenseLayer& layer);
void record_simd_gemm(Plan& plan, const ops::Linear& op, const DenseLayer& layer);
void record_tile_gemm(Plan& plan, const ops::Linear& op, const DenseLayer& layer);
void record_narrow(Plan& plan, const ops::Narrow& op, const DenseLayer& layer);
void record_layer_norm(Plan& plan, const ops::LayerNorm& op);
void record_attention(Plan& plan, const ops::Attention& op);
void record_farthest_points(Plan& plan, const ops::FarthestPoints& op);
void record_frame_normalization(Plan& plan, const ops::FrameNormalization& op);
void record_normalize(Plan& plan, const ops::Normalize& op);
void record_denormalize(Plan& plan, const ops::Denormalize& op);
void record_mask_features(Plan& plan, const ops::MaskFeatures& op);
void record_convolution(Plan& plan, const ops::Convolution& op, const ConvolutionWeights& layer);
void record_max_pool(Plan& plan, const ops::MaxPool& op);
void record_add_upsampled(Plan& plan, const ops::AddUpsampled& op);
void record_flow_step(Plan& plan, const ops::FlowStep& op, const DenseLayer& head);

}  // namespace flowdlo::vulkan
