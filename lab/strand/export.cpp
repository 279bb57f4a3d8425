#include "strand/export.hpp"

#include <fmt/format.h>

#include <cmath>

namespace flowdlo::strand {
namespace {

using torch::Tensor;

struct Folded {
  Tensor weight;  // [out, in, kernel, kernel]
  Tensor bias;    // [out]
};

/// [out, in, k, k] as [rows, k * k, columns], with zeros beyond `out` and `in`.
weights::Tensor laid_out(const std::string& name, const Tensor& weight, int rows, int columns) {
  const Tensor taps = weight.flatten(2).permute({0, 2, 1}).to(torch::kCPU).contiguous();
  Tensor padded = torch::zeros({rows, taps.size(1), columns});
  padded.slice(0, 0, taps.size(0)).slice(2, 0, taps.size(2)).copy_(taps);
  const float* const values = padded.data_ptr<float>();
  return {name + ".weight",
          {rows, static_cast<int>(taps.size(1)), columns},
          {values, values + padded.numel()}};
}

weights::Tensor laid_out(const std::string& name, const Tensor& bias, int rows) {
  Tensor padded = torch::zeros({rows});
  padded.slice(0, 0, bias.size(0)).copy_(bias.to(torch::kCPU));
  const float* const values = padded.data_ptr<float>();
  return {name + ".bias", {rows}, {values, values + padded.numel()}};
}

class Exporter {
 public:
  explicit Exporter(std::vector<weights::Tensor>& tensors) : tensors_(tensors) {}

  void add(const std::string& name, Block block, int columns = 0) {
    for (std::size_t i = 0; i < block->layers->size(); i += 2) {
      const Folded folded =
          fold(*std::dynamic_pointer_cast<torch::nn::Conv2dImpl>(block->layers->ptr(i)),
               *std::dynamic_pointer_cast<torch::nn::BatchNorm2dImpl>(block->layers->ptr(i + 1)));
      put(fmt::format("{}.{}", name, i / 2), folded, 0, i == 0 ? columns : 0);
    }
  }
  void add(const std::string& name, const torch::nn::Conv2d& convolution, int rows = 0) {
    put(name, {convolution->weight, convolution->bias}, rows, 0);
  }

 private:
  static Folded fold(const torch::nn::Conv2dImpl& convolution,
                     const torch::nn::BatchNorm2dImpl& norm) {
    const Tensor gain = norm.weight / torch::sqrt(norm.running_var + norm.options.eps());
    return {convolution.weight * gain.view({-1, 1, 1, 1}), norm.bias - norm.running_mean * gain};
  }
  void put(const std::string& name, const Folded& folded, int rows, int columns) {
    const int out = std::max(rows, static_cast<int>(folded.weight.size(0)));
    const int in = std::max(columns, static_cast<int>(folded.weight.size(1)));
    tensors_.push_back(laid_out(name, folded.weight, out, in));
    tensors_.push_back(laid_out(name, folded.bias, out));
  }

  std::vector<weights::Tensor>& tensors_;
};

/// Undoes laid_out(): what lies beyond the network's own channels is left away.
class Importer {
 public:
  explicit Importer(const weights::FieldWeights& weights) : weights_(weights) {}

  void fill(const std::string& name, Block block) const {
    for (std::size_t i = 0; i < block->layers->size(); i += 2) {
      auto& norm =
          *std::dynamic_pointer_cast<torch::nn::BatchNorm2dImpl>(block->layers->ptr(i + 1));
      const std::string layer = fmt::format("{}.{}", name, i / 2);
      take(layer, std::dynamic_pointer_cast<torch::nn::Conv2dImpl>(block->layers->ptr(i))->weight,
           norm.bias);
      norm.running_mean.zero_();
      norm.running_var.fill_(1);
      norm.weight.fill_(std::sqrt(1 + norm.options.eps()));
    }
  }
  void fill(const std::string& name, torch::nn::Conv2d& convolution) const {
    take(name, convolution->weight, convolution->bias);
  }

 private:
  void take(const std::string& name, Tensor& weight, Tensor& bias) const {
    const auto& taps = weights_.at(name + ".weight");
    const Tensor stored = torch::tensor(taps.values).view({taps.shape[0], taps.shape[1], -1});
    weight.copy_(stored.slice(0, 0, weight.size(0))
                     .slice(2, 0, weight.size(1))
                     .permute({0, 2, 1})
                     .reshape(weight.sizes()));
    bias.copy_(torch::tensor(weights_.at(name + ".bias").values).slice(0, 0, bias.size(0)));
  }

  const weights::FieldWeights& weights_;
};

}  // namespace

Network imported(const weights::FieldWeights& weights) {
  const torch::NoGradGuard no_gradients;
  Network network(NetworkConfig{weights.sizes.fine, weights.sizes.middle, weights.sizes.coarse});
  const Importer importer(weights);
  importer.fill("down_fine", network->down_fine);
  importer.fill("down_middle", network->down_middle);
  importer.fill("coarse", network->coarse);
  importer.fill("to_middle", network->to_middle);
  importer.fill("up_middle", network->up_middle);
  importer.fill("to_fine", network->to_fine);
  importer.fill("up_fine", network->up_fine);
  importer.fill("head", network->head);
  network->eval();
  return network;
}

weights::FieldWeights exported(const State& state, const std::string& notes) {
  const torch::NoGradGuard no_gradients;
  const NetworkConfig& config = state.recipe.network;
  weights::FieldWeights weights;
  weights.name = state.recipe.name;
  const DataConfig& data = state.recipe.data;
  weights.training_data = fmt::format(
      "flowdlo synth, training part, seed {}, {} scenes: {:.0f} % drawn, of the others {:.0f} % "
      "tangled, of those left {:.0f} % several and the rest wide, {:.0f} % with cords",
      data.seed, data.scenes, 100 * data.drawn, 100 * data.tangled, 100 * data.several,
      100 * data.cords);
  weights.notes = notes;
  weights.sizes = {config.fine, config.middle, config.coarse};
  Exporter exporter(weights.tensors);
  const Network& network = state.average;
  exporter.add("down_fine", network->down_fine, weights::kFieldInputs);
  exporter.add("down_middle", network->down_middle);
  exporter.add("coarse", network->coarse);
  exporter.add("to_middle", network->to_middle);
  exporter.add("up_middle", network->up_middle);
  exporter.add("to_fine", network->to_fine);
  exporter.add("up_fine", network->up_fine);
  exporter.add("head", network->head, weights::kFieldOutputs);
  return weights;
}

}  // namespace flowdlo::strand
