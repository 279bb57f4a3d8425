// The geometry-conditioned velocity model of Sec. 3.4 and spec section 6 on libtorch.
//
// Parameters are f32 (or f64) whatever the computation's type: matrix products and attention run in
// `compute`, LayerNorm, softmax and the residual stream in the parameters' own type.
#pragma once

#include <torch/torch.h>

#include <string>
#include <vector>

#include "weights/variant.hpp"

namespace flowdlo::train {

/// What one evaluation reads; B samples. Types are the parameters'.
struct ModelInput {
  torch::Tensor state;     ///< [B, 64, 3] x_t
  torch::Tensor time;      ///< [B] t
  torch::Tensor prior;     ///< [B, 64, 3] normalised
  torch::Tensor support;   ///< [B, 64, 1] h
  torch::Tensor points;    ///< [B, 256, 3] normalised
  torch::Tensor valid;     ///< [B, 256] m_obs, 1 or 0
  torch::Tensor features;  ///< [B, 64, 6 or 8] phi_M(u_j)
};

/// What the visible points contribute to every step of a frame.
struct PointMemory {
  torch::Tensor key, value;  ///< [B * 8, 256, 32]
  torch::Tensor bias;        ///< [B, 256]: 0 where valid, otherwise beyond any score
  torch::Tensor any;         ///< [B, 1, 1]: 0 where no point is valid
};

/// Eq. (3.14) and its FFN, pre-norm.
struct CrossAttentionImpl : torch::nn::Module {
  CrossAttentionImpl();
  /// points' tokens g [B, 256, 256], valid [B, 256].
  PointMemory memory(const torch::Tensor& tokens_of_points, const torch::Tensor& valid,
                     torch::ScalarType compute);
  /// tokens [B, 64, 256]; `memory` of the same B.
  torch::Tensor forward(torch::Tensor tokens, const PointMemory& memory, torch::ScalarType compute);

  torch::nn::LayerNorm norm_query{nullptr}, norm_points{nullptr}, norm_ffn{nullptr};
  torch::nn::Linear q{nullptr}, kv{nullptr}, out{nullptr}, up{nullptr}, down{nullptr};
};
TORCH_MODULE(CrossAttention);

/// One pre-norm encoder block.
struct EncoderBlockImpl : torch::nn::Module {
  EncoderBlockImpl();
  torch::Tensor forward(torch::Tensor tokens, torch::ScalarType compute);

  torch::nn::LayerNorm norm1{nullptr}, norm2{nullptr};
  torch::nn::Linear qkv{nullptr}, out{nullptr}, up{nullptr}, down{nullptr};
};
TORCH_MODULE(EncoderBlock);

struct VelocityModelImpl : torch::nn::Module {
  explicit VelocityModelImpl(const weights::Variant& variant);

  /// The head's raw output [B, 64, 3 or 4].
  torch::Tensor forward(const ModelInput& input, torch::ScalarType compute);

  /// The same in two parts, for a sampler: points' keys and values do not depend on the state.
  /// Points of one sample [1, 256, 3] serve all B samples of `prior`.
  PointMemory context(const ModelInput& input, torch::ScalarType compute);
  torch::Tensor forward(const ModelInput& input, const PointMemory& memory,
                        torch::ScalarType compute);

  weights::Variant variant;
  torch::nn::Linear state{nullptr}, prior{nullptr}, support{nullptr}, head{nullptr};
  torch::nn::Sequential time{nullptr}, points{nullptr}, local{nullptr};
  torch::Tensor node, gamma;
  CrossAttention cross{nullptr};
  torch::nn::ModuleList encoder{nullptr};
  torch::nn::LayerNorm norm{nullptr};
};
TORCH_MODULE(VelocityModel);

/// dx/dt [B, 64, 3] from the head's output, Eq. (3.27), (3.29) and spec section 6.
[[nodiscard]] torch::Tensor velocity(const weights::Variant& variant, const torch::Tensor& output,
                                     const torch::Tensor& state, const torch::Tensor& time,
                                     const torch::Tensor& prior);

}  // namespace flowdlo::train
