#include "train/weights_exchange.hpp"

namespace flowdlo::train {

std::vector<weights::Tensor> tensors_of(const VelocityModelImpl& model) {
  const auto parameters = model.named_parameters();
  std::vector<weights::Tensor> tensors;
  for (const auto& expected : weights::manifest(model.variant)) {
    const torch::Tensor values =
        parameters[expected.name].detach().to(torch::kCPU, torch::kFloat32).contiguous();
    const float* data = values.data_ptr<float>();
    tensors.push_back({expected.name, expected.shape, {data, data + values.numel()}});
  }
  return tensors;
}

void fill(VelocityModelImpl& model, const weights::Weights& weights) {
  const torch::NoGradGuard no_gradients;
  auto parameters = model.named_parameters();
  for (const auto& tensor : weights.tensors) {
    torch::Tensor& parameter = parameters[tensor.name];
    const torch::Tensor values = torch::tensor(tensor.values, torch::kFloat32);
    parameter.copy_(values.view(parameter.sizes()));
  }
}

}  // namespace flowdlo::train
