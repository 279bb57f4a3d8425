// Network: the strand field's network on libtorch, for training. A U-Net of three levels that works
// at half the region's size: 2 x 2 pixels are one place with four times the planes.
#pragma once

#include <torch/torch.h>

#include <functional>

#include "strand/recipe.hpp"

namespace flowdlo::strand {

/// Sees each batch norm and what it is given, before it is used.
using Watch = std::function<void(torch::nn::BatchNorm2dImpl& norm, const torch::Tensor& given)>;

/// Two or three convolutions of 3 x 3, each with batch norm and ReLU.
class BlockImpl : public torch::nn::Module {
 public:
  BlockImpl(int in, int out, int layers);
  torch::Tensor forward(torch::Tensor x, const Watch& watch = {});

  torch::nn::ModuleList layers;
};
TORCH_MODULE(Block);

class NetworkImpl : public torch::nn::Module {
 public:
  explicit NetworkImpl(const NetworkConfig& config);

  /// [n, kPlanes, h, w] to [n, kChannels, h, w]; h and w multiples of 8. Centre, tip, under, rope
  /// and edge are logits, directions have any length. In the precision of the planes; what it says
  /// is f32.
  torch::Tensor forward(const torch::Tensor& planes, const Watch& watch = {});

  NetworkConfig config;
  Block down_fine{nullptr};
  Block down_middle{nullptr};
  Block coarse{nullptr};
  torch::nn::Conv2d to_middle{nullptr};
  Block up_middle{nullptr};
  torch::nn::Conv2d to_fine{nullptr};
  Block up_fine{nullptr};
  torch::nn::Conv2d head{nullptr};
};
TORCH_MODULE(Network);

}  // namespace flowdlo::strand
