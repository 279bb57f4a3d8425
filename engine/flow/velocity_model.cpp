#include "flow/velocity_model.hpp"

#include <algorithm>

#include "flow/time_embedding.hpp"

namespace flowdlo::flow {
namespace {

constexpr int kLayers = 6;          // Sec. 3.4
constexpr int kFeedForward = 1024;  // spec section 6
constexpr int kFeatureColumns = 8;  // of MaskFeatures' result
constexpr int kWidth = ops::kWidth;

}  // namespace

ops::LinearLayer VelocityModel::layer(const std::string& name) {
  const auto& weight = weights_.at(name + ".weight");
  return program_.layer(name, weight.shape[0], weight.shape[1], weight.values,
                        weights_.at(name + ".bias").values);
}

VelocityModel::Norm VelocityModel::norm(const std::string& name) {
  return {program_.constant(name + ".weight", 1, kWidth, weights_.at(name + ".weight").values),
          program_.constant(name + ".bias", 1, kWidth, weights_.at(name + ".bias").values)};
}

VelocityModel::FeedForward VelocityModel::feed_forward(const std::string& norm_name,
                                                       const std::string& up,
                                                       const std::string& down) {
  return {norm(norm_name), layer(up), layer(down)};
}

/// E_prior and E_h as one layer on [prior, support]: their sum is linear in both.
ops::LinearLayer VelocityModel::prior_layer() {
  const auto& prior = weights_.at("prior.weight").values;
  const auto& support = weights_.at("support.weight").values;
  std::vector<float> weight(static_cast<std::size_t>(kWidth) * 4);
  for (std::size_t out = 0; out < kWidth; ++out) {
    std::copy_n(prior.begin() + static_cast<std::ptrdiff_t>(out) * 3, 3,
                weight.begin() + static_cast<std::ptrdiff_t>(out) * 4);
    weight[out * 4 + 3] = support[out];
  }
  std::vector<float> bias = weights_.at("prior.bias").values;
  const auto& support_bias = weights_.at("support.bias").values;
  std::transform(bias.begin(), bias.end(), support_bias.begin(), bias.begin(), std::plus<>());
  return program_.layer("prior+support", kWidth, 4, weight, bias);
}

/// gamma E_loc's last layer, Eq. (3.15), with gamma multiplied in.
ops::LinearLayer VelocityModel::scaled_local_layer() {
  const float gamma = weights_.at("gamma").values.front();
  std::vector<float> weight = weights_.at("local.2.weight").values;
  std::vector<float> bias = weights_.at("local.2.bias").values;
  for (float& value : weight) value *= gamma;
  for (float& value : bias) value *= gamma;
  return program_.layer("gamma*local.2", kWidth, kWidth, weight, bias);
}

VelocityModel::VelocityModel(ops::Program& program, const weights::Weights& weights, int draws,
                             int steps)
    : program_(program), weights_(weights), rows_(draws * ops::kRowsPerDraw), steps_(steps) {
  state_ = layer("state");
  prior_ = prior_layer();
  local0_ = layer("local.0");
  local2_ = scaled_local_layer();
  head_ = layer("head");
  final_norm_ = norm("norm");
  node_ = program_.constant("node", ops::kRowsPerDraw, kWidth, weights_.at("node").values);
  time_ = program_.constant("time", steps, kWidth, time_tokens(weights_, steps));
  if (weights_.metadata.variant.visible_points) {
    cross_ = CrossBlock{
        norm("cross.norm_query"), norm("cross.norm_points"),
        layer("cross.q"),         layer("cross.kv"),
        layer("cross.out"),       feed_forward("cross.norm_ffn", "cross.up", "cross.down"),
        layer("points.0"),        layer("points.2")};
    key_value_ = program_.scratch("key_value", ops::kVisibleRows, 2 * kWidth);
  }
  for (int i = 0; i < kLayers; ++i) {
    const std::string name = "encoder." + std::to_string(i);
    encoder_.push_back({norm(name + ".norm1"), layer(name + ".qkv"), layer(name + ".out"),
                        feed_forward(name + ".norm2", name + ".up", name + ".down")});
  }
  prior_norm_ = program_.scratch("prior_norm", rows_, 4);
  static_tokens_ = program_.scratch("static_tokens", rows_, kWidth);
  tokens_ = program_.scratch("tokens", rows_, kWidth);
  normed_ = program_.scratch("normed", rows_, kWidth);
  query_ = program_.scratch("query", rows_, kWidth);
  qkv_ = program_.scratch("qkv", rows_, 3 * kWidth);
  attended_ = program_.scratch("attended", rows_, kWidth);
  hidden_ = program_.scratch("hidden", rows_, kFeedForward);
  features_ = program_.scratch("features", rows_, kFeatureColumns);
}

void VelocityModel::record_conditions(const Conditions& conditions) {
  program_.record(
      ops::Normalize{.points = conditions.draw_prior, .norm = conditions.norm, .out = prior_norm_});
  // The part of Eq. (3.13) that no step changes: e_j + E_prior + E_h.
  program_.record(ops::Narrow{.x = prior_norm_,
                              .layer = prior_,
                              .y = static_tokens_,
                              .first = ops::Addend{node_, ops::kRowsPerDraw, 0}});
  if (!cross_) return;

  const auto points = program_.scratch("points", ops::kVisibleRows, 4);
  const auto first = program_.scratch("points.first", ops::kVisibleRows, kWidth);
  const auto second = program_.scratch("points.second", ops::kVisibleRows, kWidth);
  program_.record(
      ops::Normalize{.points = conditions.visible, .norm = conditions.norm, .out = points});
  program_.record(ops::Narrow{
      .x = points, .layer = cross_->points0, .y = first, .activation = ops::Activation::kGelu});
  program_.record(ops::Linear{.x = first, .layer = cross_->points2, .y = second});  // g_m
  program_.record(ops::LayerNorm{.x = second,
                                 .gain = cross_->norm_points.gain,
                                 .shift = cross_->norm_points.shift,
                                 .y = first});
  program_.record(ops::Linear{.x = first, .layer = cross_->kv, .y = key_value_});
}

void VelocityModel::record_feed_forward(const FeedForward& ffn) {
  program_.record(
      ops::LayerNorm{.x = tokens_, .gain = ffn.norm.gain, .shift = ffn.norm.shift, .y = normed_});
  program_.record(ops::Linear{
      .x = normed_, .layer = ffn.up, .y = hidden_, .activation = ops::Activation::kGelu});
  program_.record(ops::Linear{.x = hidden_, .layer = ffn.down, .y = tokens_, .residual = tokens_});
}

void VelocityModel::record_cross(const Conditions& conditions) {
  program_.record(ops::LayerNorm{.x = tokens_,
                                 .gain = cross_->norm_query.gain,
                                 .shift = cross_->norm_query.shift,
                                 .y = normed_});
  program_.record(ops::Linear{.x = normed_, .layer = cross_->q, .y = query_});
  program_.record(ops::Attention{.query = query_,  // Eq. (3.14)
                                 .query_column = 0,
                                 .key_value = key_value_,
                                 .key_column = 0,
                                 .value_column = kWidth,
                                 .per_draw = false,
                                 .key_valid = conditions.visible,
                                 .out = attended_});
  program_.record(
      ops::Linear{.x = attended_, .layer = cross_->out, .y = tokens_, .residual = tokens_});
  record_feed_forward(cross_->ffn);
}

void VelocityModel::record_local(const Conditions& conditions, ops::Tensor state) {
  program_.record(ops::MaskFeatures{.state = state,
                                    .norm = conditions.norm,
                                    .params = conditions.params,
                                    .field = conditions.field,
                                    .depth = conditions.depth,
                                    .out = features_});
  program_.record(ops::Narrow{
      .x = features_, .layer = local0_, .y = query_, .activation = ops::Activation::kGelu});
  program_.record(  // Eq. (3.15)
      ops::Linear{.x = query_, .layer = local2_, .y = tokens_, .residual = tokens_});
}

void VelocityModel::record_encoder(const EncoderBlock& block) {
  program_.record(ops::LayerNorm{
      .x = tokens_, .gain = block.norm.gain, .shift = block.norm.shift, .y = normed_});
  program_.record(ops::Linear{.x = normed_, .layer = block.qkv, .y = qkv_});
  program_.record(ops::Attention{.query = qkv_,
                                 .query_column = 0,
                                 .key_value = qkv_,
                                 .key_column = kWidth,
                                 .value_column = 2 * kWidth,
                                 .per_draw = true,
                                 .key_valid = std::nullopt,
                                 .out = attended_});
  program_.record(
      ops::Linear{.x = attended_, .layer = block.out, .y = tokens_, .residual = tokens_});
  record_feed_forward(block.ffn);
}

void VelocityModel::record_step(const Conditions& conditions, ops::Tensor state, int k) {
  program_.stage("embedding");
  program_.record(ops::Narrow{.x = state,  // Eq. (3.13)
                              .layer = state_,
                              .y = tokens_,
                              .first = ops::Addend{static_tokens_, rows_, 0},
                              .second = ops::Addend{time_, 1, k}});
  if (cross_) {
    program_.stage("cross_attention");
    record_cross(conditions);
  }
  program_.stage("mask_features");
  record_local(conditions, state);
  program_.stage("encoder");
  for (const EncoderBlock& block : encoder_) record_encoder(block);
  program_.stage("head");
  program_.record(ops::LayerNorm{
      .x = tokens_, .gain = final_norm_.gain, .shift = final_norm_.shift, .y = normed_});
  const auto& variant = weights_.metadata.variant;
  program_.record(
      ops::FlowStep{.hidden = normed_,
                    .head = head_,
                    .prior = prior_norm_,
                    .state = state,
                    .parameterization = variant.parameterization,
                    .prior_sd = variant.prior_sd,
                    .t = static_cast<float>(k) / static_cast<float>(steps_),  // Eq. (3.26)
                    .dt = 1.0F / static_cast<float>(steps_)});
}

}  // namespace flowdlo::flow
