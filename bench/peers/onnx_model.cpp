#include "peers/onnx_model.hpp"

#include <cmath>

#include "ops/program.hpp"
#include "peers/onnx_graph.hpp"

namespace flowdlo::peers {
namespace {

constexpr std::int64_t kWidth = ops::kWidth;
constexpr std::int64_t kHeads = ops::kHeads;
constexpr std::int64_t kHeadWidth = ops::kHeadWidth;
constexpr std::int64_t kNodes = ops::kRowsPerDraw;
constexpr std::int64_t kPoints = ops::kVisibleRows;
constexpr int kLayers = 6;

/// The model's vocabulary over a graph.
class Writer {
 public:
  Writer(const weights::Weights& weights, int draws) : weights_(weights), draws_(draws) {}

  [[nodiscard]] std::int64_t rows() const { return draws_ * kNodes; }
  OnnxGraph& graph() { return graph_; }

  std::string constant(const std::string& name) {
    const auto& tensor = weights_.at(name);
    return graph_.tensor(name, {tensor.shape.begin(), tensor.shape.end()}, tensor.values);
  }
  /// x W^T + b.
  std::string linear(const std::string& x, const std::string& name) {
    return graph_.node("Gemm", {x, constant(name + ".weight"), constant(name + ".bias")},
                       {{.name = "transB", .integers = {1}}});
  }
  std::string norm(const std::string& x, const std::string& name) {
    return graph_.node(
        "LayerNormalization", {x, constant(name + ".weight"), constant(name + ".bias")},
        {{.name = "axis", .integers = {-1}},
         {.name = "epsilon", .integers = {}, .real = true, .number = ops::kLayerNormEpsilon}});
  }
  std::string add(const std::string& a, const std::string& b) { return graph_.node("Add", {a, b}); }
  std::string gelu(const std::string& x) { return graph_.node("Gelu", {x}); }
  std::string reshape(const std::string& x, const Shape& shape) {
    return graph_.node("Reshape", {x, graph_.integers(shape)});
  }
  std::string transpose(const std::string& x, const Shape& order) {
    return graph_.node("Transpose", {x}, {{.name = "perm", .integers = order, .list = true}});
  }
  /// Rows [batch * n, 256] to heads [batch, 8, n, 32].
  std::string heads(const std::string& x, std::int64_t batch) {
    return transpose(reshape(x, {batch, -1, kHeads, kHeadWidth}), {0, 2, 1, 3});
  }
  std::vector<std::string> split(const std::string& x, int parts) {
    return graph_.nodes(
        "Split", {x},
        {{.name = "axis", .integers = {1}}, {.name = "num_outputs", .integers = {parts}}}, parts);
  }
  /// softmax(q k^T / sqrt(32) + bias) v; q [D, 8, 64, 32], k transposed. [M, 256].
  std::string attend(const std::string& q, const std::string& key, const std::string& value,
                     const std::string& bias) {
    const float scale = 1.0F / std::sqrt(static_cast<float>(kHeadWidth));
    const std::string name = "scale_" + std::to_string(scales_++);
    std::string scores = graph_.node("MatMul", {q, key});
    scores = graph_.node("Mul", {scores, graph_.tensor(name, {}, std::span(&scale, 1))});
    if (!bias.empty()) scores = add(scores, bias);
    const auto soft = graph_.node("Softmax", {scores}, {{.name = "axis", .integers = {-1}}});
    const auto mixed = transpose(graph_.node("MatMul", {soft, value}), {0, 2, 1, 3});
    return reshape(mixed, {rows(), kWidth});
  }
  std::string feed_forward(const std::string& tokens, const std::string& norm_name,
                           const std::string& up, const std::string& down) {
    return add(tokens, linear(gelu(linear(norm(tokens, norm_name), up)), down));
  }
  std::string encoder(std::string tokens, const std::string& name) {
    const auto qkv = split(linear(norm(tokens, name + ".norm1"), name + ".qkv"), 3);
    const auto key = transpose(reshape(qkv[1], {draws_, -1, kHeads, kHeadWidth}), {0, 2, 3, 1});
    const auto attended = attend(heads(qkv[0], draws_), key, heads(qkv[2], draws_), {});
    tokens = add(tokens, linear(attended, name + ".out"));
    return feed_forward(tokens, name + ".norm2", name + ".up", name + ".down");
  }

 private:
  const weights::Weights& weights_;
  std::int64_t draws_;
  OnnxGraph graph_;
  int scales_ = 0;
};

}  // namespace

std::string onnx_conditions(const weights::Weights& weights, int draws) {
  Writer write(weights, draws);
  OnnxGraph& graph = write.graph();
  const auto prior = graph.input("prior", {write.rows(), 3});
  const auto support = graph.input("support", {write.rows(), 1});
  auto still = write.add(write.linear(prior, "prior"), write.linear(support, "support"));
  still = write.add(write.reshape(still, {draws, kNodes, kWidth}), write.constant("node"));
  graph.output(write.reshape(still, {write.rows(), kWidth}), "still", {write.rows(), kWidth});
  if (weights.metadata.variant.visible_points) {
    const auto points = graph.input("points", {kPoints, 3});
    const auto tokens = write.linear(write.gelu(write.linear(points, "points.0")), "points.2");
    const auto parts =
        write.split(write.linear(write.norm(tokens, "cross.norm_points"), "cross.kv"), 2);
    const auto key =
        write.transpose(write.reshape(parts[0], {1, -1, kHeads, kHeadWidth}), {0, 2, 3, 1});
    graph.output(key, "key", {1, kHeads, kHeadWidth, kPoints});
    graph.output(write.heads(parts[1], 1), "value", {1, kHeads, kPoints, kHeadWidth});
  }
  return graph.model();
}

std::string onnx_step(const weights::Weights& weights, int draws) {
  const auto& variant = weights.metadata.variant;
  Writer write(weights, draws);
  OnnxGraph& graph = write.graph();
  const auto state = graph.input("state", {write.rows(), 3});
  const auto time = graph.input("time", {1, kWidth});
  const auto features = graph.input("features", {write.rows(), variant.local_channels});
  const auto still = graph.input("still", {write.rows(), kWidth});
  auto tokens = write.add(write.add(write.linear(state, "state"), still), time);  // Eq. (3.13)
  if (variant.visible_points) {
    const auto key = graph.input("key", {1, kHeads, kHeadWidth, kPoints});
    const auto value = graph.input("value", {1, kHeads, kPoints, kHeadWidth});
    const auto bias = graph.input("bias", {1, 1, 1, kPoints});
    const auto query = write.linear(write.norm(tokens, "cross.norm_query"), "cross.q");
    const auto attended = write.attend(write.heads(query, draws), key, value, bias);
    tokens = write.add(tokens, write.linear(attended, "cross.out"));  // Eq. (3.14)
    tokens = write.feed_forward(tokens, "cross.norm_ffn", "cross.up", "cross.down");
  }
  const auto local = write.linear(write.gelu(write.linear(features, "local.0")), "local.2");
  tokens = write.add(tokens, graph.node("Mul", {local, write.constant("gamma")}));  // Eq. (3.15)
  for (int i = 0; i < kLayers; ++i) tokens = write.encoder(tokens, "encoder." + std::to_string(i));
  graph.output(write.linear(write.norm(tokens, "norm"), "head"), "output",
               {write.rows(), variant.head_channels});
  return graph.model();
}

}  // namespace flowdlo::peers
