// The tensors of the velocity model, in the order of the table in spec section 6.
#include <fmt/format.h>

#include "weights/weights.hpp"

namespace flowdlo::weights {
namespace {

constexpr int kFeedForward = 1024;
constexpr int kLayers = 6;
constexpr int kCoordinates = 3;

void add_linear(std::vector<Expected>& list, const std::string& name, int in, int out) {
  list.push_back({name + ".weight", {out, in}});
  list.push_back({name + ".bias", {out}});
}

void add_norm(std::vector<Expected>& list, const std::string& name) {
  list.push_back({name + ".weight", {ops::kWidth}});
  list.push_back({name + ".bias", {ops::kWidth}});
}

void add_feed_forward(std::vector<Expected>& list, const std::string& prefix) {
  add_linear(list, prefix + ".up", ops::kWidth, kFeedForward);
  add_linear(list, prefix + ".down", kFeedForward, ops::kWidth);
}

void add_cross_attention(std::vector<Expected>& list) {  // Eq. (3.14)
  add_linear(list, "points.0", kCoordinates, ops::kWidth);
  add_linear(list, "points.2", ops::kWidth, ops::kWidth);
  add_norm(list, "cross.norm_query");
  add_norm(list, "cross.norm_points");
  add_linear(list, "cross.q", ops::kWidth, ops::kWidth);
  add_linear(list, "cross.kv", ops::kWidth, 2 * ops::kWidth);
  add_linear(list, "cross.out", ops::kWidth, ops::kWidth);
  add_norm(list, "cross.norm_ffn");
  add_feed_forward(list, "cross");
}

void add_encoder_layer(std::vector<Expected>& list, const std::string& prefix) {
  add_norm(list, prefix + ".norm1");
  add_linear(list, prefix + ".qkv", ops::kWidth, 3 * ops::kWidth);
  add_linear(list, prefix + ".out", ops::kWidth, ops::kWidth);
  add_norm(list, prefix + ".norm2");
  add_feed_forward(list, prefix);
}

}  // namespace

std::vector<Expected> manifest(const Variant& variant) {
  std::vector<Expected> list;
  add_linear(list, "state", kCoordinates, ops::kWidth);  // E_x, Eq. (3.13)
  add_linear(list, "time.0", ops::kWidth, ops::kWidth);  // E_t
  add_linear(list, "time.2", ops::kWidth, ops::kWidth);
  list.push_back({"node", {ops::kRowsPerDraw, ops::kWidth}});  // e_j
  add_linear(list, "prior", kCoordinates, ops::kWidth);        // E_prior
  add_linear(list, "support", 1, ops::kWidth);                 // E_h
  if (variant.visible_points) add_cross_attention(list);
  add_linear(list, "local.0", variant.local_channels, ops::kWidth);  // E_loc, Eq. (3.15)
  add_linear(list, "local.2", ops::kWidth, ops::kWidth);
  list.push_back({"gamma", {}});
  for (int layer = 0; layer < kLayers; ++layer) {
    add_encoder_layer(list, fmt::format("encoder.{}", layer));
  }
  add_norm(list, "norm");
  add_linear(list, "head", ops::kWidth, variant.head_channels);
  return list;
}

}  // namespace flowdlo::weights
