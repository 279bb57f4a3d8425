#include "peers/onnx_peer.hpp"

#include <algorithm>
#include <cstdio>

#include "flow/time_embedding.hpp"
#include "peers/onnx_model.hpp"
#include "peers/onnx_runtime.hpp"

namespace flowdlo::peers {
namespace {

/// Columns [first, first + count) of rows of `width`.
void columns_of(const std::vector<float>& rows, std::size_t width, std::size_t first,
                std::size_t count, std::vector<float>& out) {
  out.resize(rows.size() / width * count);
  for (std::size_t row = 0; row * width < rows.size(); ++row) {
    std::copy_n(rows.data() + row * width + first, count, out.data() + row * count);
  }
}

std::vector<float> columns_of(const std::vector<float>& rows, std::size_t width, std::size_t first,
                              std::size_t count) {
  std::vector<float> out;
  columns_of(rows, width, first, count, out);
  return out;
}

class OnnxPeer final : public Peer {
 public:
  OnnxPeer(const Problem& problem, std::string version, OnnxSession conditions, OnnxSession step)
      : problem_(problem),
        version_(std::move(version)),
        conditions_(std::move(conditions)),
        step_(std::move(step)),
        prior_rows_(problem.normalised(problem.prior)),
        time_(flow::time_tokens(problem.weights, problem.steps)) {
    prior_ = columns_of(prior_rows_, 4, 0, 3);
    support_ = columns_of(prior_rows_, 4, 3, 1);
    points_ = columns_of(problem.normalised(problem.visible), 4, 0, 3);
    bias_ = columns_of(problem.visible, 4, 3, 1);
    for (float& value : bias_) value = value > 0.5F ? 0.0F : -1e30F;
    still_.resize(static_cast<std::size_t>(problem.rows()) * ops::kWidth);
    key_.resize(static_cast<std::size_t>(ops::kVisibleRows) * ops::kWidth);
    value_.resize(key_.size());
  }

  [[nodiscard]] std::string name() const override { return "ONNX Runtime " + version_; }

  void sample(std::vector<float>& state) override {
    const auto& variant = problem_.weights.metadata.variant;
    const auto done = evaluate_conditions();
    if (!done) std::fprintf(stderr, "%s\n", done.error().message.c_str());
    state = problem_.source;
    output_.resize(static_cast<std::size_t>(problem_.rows() * variant.head_channels));
    const float dt = 1.0F / static_cast<float>(problem_.steps);
    for (int k = 0; k < problem_.steps; ++k) {
      problem_.features(state, features_);
      const auto ran = evaluate_step(state, k);
      if (!ran) std::fprintf(stderr, "%s\n", ran.error().message.c_str());
      const float t = static_cast<float>(k) / static_cast<float>(problem_.steps);
      const auto channels = static_cast<std::size_t>(variant.head_channels);
      for (std::size_t row = 0; row * 4 < state.size(); ++row) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
          float& x = state[row * 4 + axis];
          x += dt *
               problem_.velocity(t, output_[row * channels + axis], x, prior_rows_[row * 4 + axis]);
        }
      }
    }
  }

 private:
  Result<void> evaluate_conditions() {
    std::vector<OnnxTensor> inputs{{"prior", {problem_.rows(), 3}, prior_},
                                   {"support", {problem_.rows(), 1}, support_}};
    std::vector<OnnxTensor> outputs{{"still", {problem_.rows(), ops::kWidth}, still_}};
    if (problem_.weights.metadata.variant.visible_points) {
      inputs.push_back({"points", {ops::kVisibleRows, 3}, points_});
      outputs.push_back({"key", {1, ops::kHeads, ops::kHeadWidth, ops::kVisibleRows}, key_});
      outputs.push_back({"value", {1, ops::kHeads, ops::kVisibleRows, ops::kHeadWidth}, value_});
    }
    return conditions_.run(inputs, outputs);
  }

  Result<void> evaluate_step(const std::vector<float>& state, int k) {
    const auto& variant = problem_.weights.metadata.variant;
    columns_of(state, 4, 0, 3, state_);
    columns_of(features_, 8, 0, static_cast<std::size_t>(variant.local_channels), local_);
    const std::span<float> token(time_.data() + static_cast<std::ptrdiff_t>(k) * ops::kWidth,
                                 ops::kWidth);
    std::vector<OnnxTensor> inputs{{"state", {problem_.rows(), 3}, state_},
                                   {"time", {1, ops::kWidth}, token},
                                   {"features", {problem_.rows(), variant.local_channels}, local_},
                                   {"still", {problem_.rows(), ops::kWidth}, still_}};
    if (variant.visible_points) {
      inputs.push_back({"key", {1, ops::kHeads, ops::kHeadWidth, ops::kVisibleRows}, key_});
      inputs.push_back({"value", {1, ops::kHeads, ops::kVisibleRows, ops::kHeadWidth}, value_});
      inputs.push_back({"bias", {1, 1, 1, ops::kVisibleRows}, bias_});
    }
    const OnnxTensor output{"output", {problem_.rows(), variant.head_channels}, output_};
    return step_.run(inputs, std::span(&output, 1));
  }

  const Problem& problem_;
  std::string version_;
  OnnxSession conditions_;
  OnnxSession step_;
  std::vector<float> prior_rows_;
  std::vector<float> time_;
  std::vector<float> prior_, support_, points_, bias_;  // inputs of a frame
  std::vector<float> still_, key_, value_;              // what a frame fixes
  std::vector<float> state_, features_, local_, output_;
};

}  // namespace

Result<std::unique_ptr<Peer>> onnx_peer(const Problem& problem,
                                        const std::filesystem::path& library) {
  const auto runtime = OnnxRuntime::open(library);
  if (!runtime) return runtime.error();
  // On one thread: idle workers of a second pool would spin beside the steps' own.
  auto conditions =
      OnnxSession::create(*runtime, onnx_conditions(problem.weights, problem.draws), 1);
  if (!conditions) return conditions.error();
  auto step =
      OnnxSession::create(*runtime, onnx_step(problem.weights, problem.draws), problem.threads);
  if (!step) return step.error();
  return std::unique_ptr<Peer>(std::make_unique<OnnxPeer>(
      problem, (*runtime)->version(), *std::move(conditions), *std::move(step)));
}

}  // namespace flowdlo::peers
