#include "peers/torch_peer.hpp"

#include <algorithm>

#include "train/blas.hpp"
#include "train/velocity_model.hpp"
#include "train/weights_exchange.hpp"

namespace flowdlo::peers {
namespace {

using torch::Tensor;

/// Columns [0, columns) of rows [.., width].
Tensor columns_of(const std::vector<float>& rows, std::int64_t width, std::int64_t columns) {
  return torch::tensor(rows, torch::kFloat32).view({-1, width}).narrow(1, 0, columns).contiguous();
}

class TorchPeer final : public Peer {
 public:
  explicit TorchPeer(const Problem& problem)
      : problem_(problem), model_(problem.weights.metadata.variant), rows_(problem.source.size()) {
    train::fill(*model_, problem.weights);
    model_->eval();
    const std::int64_t draws = problem.draws;
    const auto by_draw = [&](const Tensor& rows) { return rows.view({draws, 64, -1}); };
    const auto prior = problem.normalised(problem.prior);
    input_.prior = by_draw(columns_of(prior, 4, 3));
    input_.support = by_draw(columns_of(prior, 4, 4).narrow(1, 3, 1).contiguous());
    input_.points = columns_of(problem.normalised(problem.visible), 4, 3).unsqueeze(0);
    input_.valid = columns_of(problem.visible, 4, 4).select(1, 3).contiguous().unsqueeze(0);
    source_ = by_draw(columns_of(problem.source, 4, 3));
  }

  [[nodiscard]] std::string name() const override {
    return "libtorch " TORCH_VERSION ", " + train::find_blas().name.substr(0, 15);
  }

  void sample(std::vector<float>& state) override {
    const c10::InferenceMode inference;
    const auto context = model_->context(input_, torch::kFloat32);  // points: once a frame
    Tensor x = source_;
    train::ModelInput input = input_;
    for (int k = 0; k < problem_.steps; ++k) {
      input.state = x;
      input.time = torch::full({x.size(0)}, static_cast<double>(k) / problem_.steps);
      input.features = features(x);
      const Tensor output = model_->forward(input, context, torch::kFloat32);
      x = x + train::velocity(model_->variant, output, x, input.time, input.prior) /
                  static_cast<double>(problem_.steps);
    }
    spread(x, state);
  }

 private:
  /// [D, 64, 3] to rows of four.
  static void spread(const Tensor& x, std::vector<float>& rows) {
    const Tensor flat = x.contiguous();
    const float* from = flat.data_ptr<float>();
    for (std::size_t row = 0; row * 4 < rows.size(); ++row) {
      std::copy_n(from + row * 3, 3, rows.data() + row * 4);
    }
  }

  Tensor features(const Tensor& x) {
    spread(x, rows_);
    problem_.features(rows_, features_);
    const std::int64_t channels = model_->variant.local_channels;
    return torch::from_blob(features_.data(), {x.size(0), 64, 8}).narrow(2, 0, channels);
  }

  const Problem& problem_;
  train::VelocityModel model_;
  train::ModelInput input_;
  Tensor source_;
  std::vector<float> rows_;
  std::vector<float> features_;
};

}  // namespace

std::unique_ptr<Peer> torch_peer(const Problem& problem) {
  at::set_num_threads(problem.threads);
  train::set_blas_threads(problem.threads);
  return std::make_unique<TorchPeer>(problem);
}

}  // namespace flowdlo::peers
