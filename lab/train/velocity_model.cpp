#include "train/velocity_model.hpp"

#include <cmath>

#include "flowdlo/centerline.hpp"
#include "ops/program.hpp"

namespace flowdlo::train {
namespace {

namespace nn = torch::nn;
using torch::Tensor;

constexpr std::int64_t kWidth = ops::kWidth;
constexpr std::int64_t kHeads = ops::kHeads;
constexpr std::int64_t kHeadWidth = ops::kHeadWidth;
constexpr std::int64_t kFeedForward = 1024;  // spec section 6
constexpr int kLayers = 6;
constexpr double kNodeDeviation = 0.02;

nn::LayerNorm layer_norm() {
  return nn::LayerNorm(nn::LayerNormOptions({kWidth}).eps(ops::kLayerNormEpsilon));
}

/// x W^T + b in `compute`.
Tensor dense(const Tensor& x, const nn::Linear& layer, torch::ScalarType compute) {
  return torch::linear(x.to(compute), layer->weight.to(compute), layer->bias.to(compute));
}

/// x W^T + b in the parameters' own type: for the few inputs whose digits matter.
Tensor exact(const Tensor& x, const nn::Linear& layer) {
  return torch::linear(x, layer->weight, layer->bias);
}

Tensor feed_forward(const Tensor& normed, const nn::Linear& up, const nn::Linear& down,
                    torch::ScalarType compute) {
  return dense(torch::gelu(dense(normed, up, compute)), down, compute);
}

nn::Linear layer(const nn::Sequential& block, std::size_t index) {
  return nn::Linear(std::dynamic_pointer_cast<nn::LinearImpl>(block->ptr(index)));
}

/// [B, rows, parts * 256] to `parts` tensors [B * 8, rows, 32].
std::vector<Tensor> heads(const Tensor& x, std::int64_t parts) {
  const auto batch = x.size(0);
  const auto rows = x.size(1);
  const Tensor split =
      x.view({batch, rows, parts, kHeads, kHeadWidth}).permute({2, 0, 3, 1, 4}).contiguous();
  std::vector<Tensor> result;
  for (std::int64_t part = 0; part < parts; ++part) {
    result.push_back(split[part].view({batch * kHeads, rows, kHeadWidth}));
  }
  return result;
}

/// softmax(q k^T / sqrt(32) + bias) v of heads [B * 8, rows, 32]; the result is [B, rows, 256].
/// `bias` [B, keys] is added before the softmax, where given.
Tensor attend(const Tensor& q, const Tensor& k, const Tensor& v, const Tensor& bias,
              torch::ScalarType outer) {
  const double scale = 1.0 / std::sqrt(static_cast<double>(kHeadWidth));
  const auto batch = q.size(0) / kHeads;
  Tensor scores = torch::bmm(q * scale, k.transpose(1, 2)).to(outer);
  if (bias.defined()) {
    scores = (scores.view({batch, kHeads * q.size(1), k.size(1)}) + bias.unsqueeze(1))
                 .view({batch * kHeads, q.size(1), k.size(1)});
  }
  const Tensor weights = torch::softmax(scores, -1).to(q.scalar_type());
  return torch::bmm(weights, v)
      .view({batch, kHeads, q.size(1), kHeadWidth})
      .transpose(1, 2)
      .reshape({batch, q.size(1), kWidth});
}

/// 128 sines, then 128 cosines, of 1000 t at frequencies 10000^(-i / 128). Spec section 6.
Tensor sinusoids(const Tensor& time) {
  constexpr std::int64_t kHalf = kWidth / 2;
  const auto options = torch::TensorOptions().dtype(torch::kFloat64);
  const Tensor frequency =
      torch::exp(torch::arange(kHalf, options) * (-std::log(10000.0) / kHalf)).to(time.device());
  const Tensor angle = (time.to(torch::kFloat64) * 1000.0).unsqueeze(1) * frequency;
  return torch::cat({torch::sin(angle), torch::cos(angle)}, 1).to(time.scalar_type());
}

}  // namespace

CrossAttentionImpl::CrossAttentionImpl() {
  norm_query = register_module("norm_query", layer_norm());
  norm_points = register_module("norm_points", layer_norm());
  q = register_module("q", nn::Linear(kWidth, kWidth));
  kv = register_module("kv", nn::Linear(kWidth, 2 * kWidth));
  out = register_module("out", nn::Linear(kWidth, kWidth));
  norm_ffn = register_module("norm_ffn", layer_norm());
  up = register_module("up", nn::Linear(kWidth, kFeedForward));
  down = register_module("down", nn::Linear(kFeedForward, kWidth));
}

PointMemory CrossAttentionImpl::memory(const Tensor& tokens_of_points, const Tensor& valid,
                                       torch::ScalarType compute) {
  constexpr double kMasked =
      -1e30;  // exp of it is 0; minus infinity would make NaN of no key at all
  const auto key_value = heads(dense(norm_points(tokens_of_points), kv, compute), 2);
  const Tensor any = valid.amax(1).view({-1, 1, 1});  // no valid point: the attention gives 0
  return {key_value[0], key_value[1], (1 - valid) * kMasked, any.to(compute)};
}

Tensor CrossAttentionImpl::forward(Tensor tokens, const PointMemory& memory,
                                   torch::ScalarType compute) {
  const auto outer = tokens.scalar_type();
  const auto query = heads(dense(norm_query(tokens), q, compute), 1);
  const Tensor attended =
      attend(query[0], memory.key, memory.value, memory.bias, outer) * memory.any;
  tokens = tokens + dense(attended, out, compute).to(outer);
  return tokens + feed_forward(norm_ffn(tokens), up, down, compute).to(outer);
}

EncoderBlockImpl::EncoderBlockImpl() {
  norm1 = register_module("norm1", layer_norm());
  qkv = register_module("qkv", nn::Linear(kWidth, 3 * kWidth));
  out = register_module("out", nn::Linear(kWidth, kWidth));
  norm2 = register_module("norm2", layer_norm());
  up = register_module("up", nn::Linear(kWidth, kFeedForward));
  down = register_module("down", nn::Linear(kFeedForward, kWidth));
}

Tensor EncoderBlockImpl::forward(Tensor tokens, torch::ScalarType compute) {
  const auto outer = tokens.scalar_type();
  const auto parts = heads(dense(norm1(tokens), qkv, compute), 3);
  const Tensor attended = attend(parts[0], parts[1], parts[2], {}, outer);
  tokens = tokens + dense(attended, out, compute).to(outer);
  return tokens + feed_forward(norm2(tokens), up, down, compute).to(outer);
}

VelocityModelImpl::VelocityModelImpl(const weights::Variant& kind) : variant(kind) {
  state = register_module("state", nn::Linear(3, kWidth));  // E_x, Eq. (3.13)
  time = register_module(
      "time", nn::Sequential(nn::Linear(kWidth, kWidth), nn::SiLU(), nn::Linear(kWidth, kWidth)));
  node = register_parameter("node", torch::randn({kNodes, kWidth}) * kNodeDeviation);  // e_j
  prior = register_module("prior", nn::Linear(3, kWidth));
  support = register_module("support", nn::Linear(1, kWidth));
  if (variant.visible_points) {
    points = register_module(
        "points", nn::Sequential(nn::Linear(3, kWidth), nn::GELU(), nn::Linear(kWidth, kWidth)));
    cross = register_module("cross", CrossAttention());
  }
  local = register_module("local", nn::Sequential(nn::Linear(variant.local_channels, kWidth),
                                                  nn::GELU(), nn::Linear(kWidth, kWidth)));
  gamma = register_parameter("gamma", torch::ones({}));  // Eq. (3.15)
  encoder = register_module("encoder", nn::ModuleList());
  for (int layer = 0; layer < kLayers; ++layer) encoder->push_back(EncoderBlock());
  norm = register_module("norm", layer_norm());
  head = register_module("head", nn::Linear(kWidth, variant.head_channels));
}

PointMemory VelocityModelImpl::context(const ModelInput& input, torch::ScalarType compute) {
  if (!variant.visible_points) return {};
  const auto outer = input.points.scalar_type();
  const Tensor first = torch::gelu(exact(input.points, layer(points, 0)).to(compute));
  const Tensor tokens = dense(first, layer(points, 2), compute).to(outer);  // g_m
  PointMemory memory = cross->memory(tokens, input.valid, compute);
  const auto copies = input.prior.size(0) / input.points.size(0);
  if (copies == 1) return memory;
  return {memory.key.repeat({copies, 1, 1}), memory.value.repeat({copies, 1, 1}),
          memory.bias.repeat({copies, 1}), memory.any.repeat({copies, 1, 1})};
}

Tensor VelocityModelImpl::forward(const ModelInput& input, const PointMemory& memory,
                                  torch::ScalarType compute) {
  const auto outer = input.state.scalar_type();
  const Tensor time_token = time->forward(sinusoids(input.time)).unsqueeze(1);
  Tensor tokens = exact(input.state, state) + time_token + node + exact(input.prior, prior) +
                  exact(input.support, support);                                 // Eq. (3.13)
  if (variant.visible_points) tokens = cross->forward(tokens, memory, compute);  // Eq. (3.14)
  const Tensor first = torch::gelu(exact(input.features, layer(local, 0)).to(compute));
  tokens = tokens + gamma * dense(first, layer(local, 2), compute).to(outer);  // Eq. (3.15)
  for (const auto& block : *encoder) {
    tokens = block->as<EncoderBlock>()->forward(tokens, compute);
  }
  return exact(norm(tokens), head);
}

Tensor VelocityModelImpl::forward(const ModelInput& input, torch::ScalarType compute) {
  return forward(input, context(input, compute), compute);
}

Tensor velocity(const weights::Variant& variant, const Tensor& output, const Tensor& state,
                const Tensor& time, const Tensor& prior) {
  constexpr double kEpsilon = 1e-6;  // Eq. (3.29)
  const Tensor o = output.narrow(-1, 0, 3);
  const Tensor t = time.view({-1, 1, 1});
  switch (variant.parameterization) {
    case ops::Parameterization::kVelocity:
      return o;  // Eq. (3.27)
    case ops::Parameterization::kDirect:
      return (o - state) / torch::clamp_min(1 - t, kEpsilon);  // Eq. (3.29)
    case ops::Parameterization::kPreconditioned: {
      const auto s = static_cast<double>(variant.prior_sd);
      const Tensor den = t * t * (s * s) + (1 - t) * (1 - t);
      return prior + (t * (s * s) - (1 - t)) / den * (state - t * prior) + s / den.sqrt() * o;
    }
  }
  return o;
}

}  // namespace flowdlo::train
