#include <torch/torch.h>

#include <algorithm>
#include <map>

#include "field/channel.hpp"
#include "peers/field_peers.hpp"
#include "train/blas.hpp"

namespace flowdlo::peers {
namespace {

using torch::Tensor;

constexpr std::int64_t kFold = field::kFold * field::kFold;  // pixels of a place

/// The layers as they are exported, batch norms folded: the trainer's network would still have
/// them.
class TorchFieldPeer final : public FieldPeer {
 public:
  TorchFieldPeer(const FieldProblem& problem, bool channels_last)
      : problem_(problem),
        format_(channels_last ? torch::MemoryFormat::ChannelsLast
                              : torch::MemoryFormat::Contiguous) {
    for (const auto& expected : weights::field_manifest(problem.weights->sizes)) {
      const auto& stored = problem.weights->at(expected.name);
      Tensor tensor = torch::tensor(stored.values);
      if (stored.shape.size() == 3) {  // [out, taps, in] to [out, in, taps]
        const std::int64_t side = stored.shape[1] == 1 ? 1 : 3;
        tensor = tensor.view({stored.shape[0], stored.shape[1], stored.shape[2]})
                     .permute({0, 2, 1})
                     .reshape({stored.shape[0], stored.shape[2], side, side});
      }
      // Rows that fill up to what FlowDLO's kernels take are not needed here.
      if (expected.name.starts_with("head.")) tensor = tensor.slice(0, 0, kFold * field::kChannels);
      if (expected.name == "down_fine.0.weight") {
        tensor = tensor.slice(1, 0, kFold * field::kPlanes);
      }
      layers_[expected.name] = tensor.dim() == 4 ? tensor.contiguous(format_) : tensor.contiguous();
    }
    planes_ = torch::tensor(problem.planes)
                  .view({1, field::kPlanes, problem.height(), problem.width()})
                  .contiguous();
  }

  [[nodiscard]] std::string name() const override {
    return "libtorch " TORCH_VERSION ", " + train::find_blas().name.substr(0, 15) +
           (at::hasMKLDNN() ? ", oneDNN" : ", no oneDNN") +
           (format_ == torch::MemoryFormat::ChannelsLast ? ", channels last" : "");
  }

  void see(std::vector<float>* said) override {
    const c10::InferenceMode inference;
    const Tensor x = torch::pixel_unshuffle(planes_, field::kFold).contiguous(format_);
    const Tensor fine = square("down_fine.1", square("down_fine.0", x));
    const Tensor middle =
        square("down_middle.1", square("down_middle.0", torch::max_pool2d(fine, 2)));
    Tensor coarse = torch::max_pool2d(middle, 2);
    for (const char* layer : {"coarse.0", "coarse.1", "coarse.2"}) coarse = square(layer, coarse);
    const Tensor half =
        square("up_middle.1", square("up_middle.0", middle + twice(convolve("to_middle", coarse))));
    const Tensor whole =
        square("up_fine.1", square("up_fine.0", fine + twice(convolve("to_fine", half))));
    Tensor out = torch::pixel_shuffle(convolve("head", whole), field::kFold).contiguous();
    for (const int c : {field::kCentre, field::kTip, field::kUnder, field::kRope, field::kEdge}) {
      out.select(1, c).sigmoid_();
    }
    if (said != nullptr) said->assign(out.data_ptr<float>(), out.data_ptr<float>() + out.numel());
  }

 private:
  [[nodiscard]] Tensor convolve(const std::string& name, const Tensor& x) const {
    const Tensor& weight = layers_.at(name + ".weight");
    return torch::conv2d(x, weight, layers_.at(name + ".bias"), 1, weight.size(2) / 2);
  }
  [[nodiscard]] Tensor square(const std::string& name, const Tensor& x) const {
    return convolve(name, x).relu_();
  }
  static Tensor twice(const Tensor& x) {
    return torch::upsample_nearest2d(x, {2 * x.size(2), 2 * x.size(3)});
  }

  const FieldProblem& problem_;
  torch::MemoryFormat format_;
  std::map<std::string, Tensor> layers_;
  Tensor planes_;
};

}  // namespace

std::unique_ptr<FieldPeer> torch_field_peer(const FieldProblem& problem, bool channels_last) {
  at::set_num_threads(problem.threads);
  train::set_blas_threads(problem.threads);
  return std::make_unique<TorchFieldPeer>(problem, channels_last);
}

}  // namespace flowdlo::peers
