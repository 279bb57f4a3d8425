#include "strand/network.hpp"

#include "field/channel.hpp"
#include "field/sight.hpp"

namespace flowdlo::strand {
namespace {

namespace nn = torch::nn;
using torch::Tensor;

constexpr int kFold = 4;  // pixels of one place

nn::Conv2d pointwise(int in, int out) { return nn::Conv2d(nn::Conv2dOptions(in, out, 1)); }

/// In the precision of `x`.
Tensor convolve(const nn::Conv2dImpl& layer, const Tensor& x) {
  const Tensor bias = layer.bias.defined() ? layer.bias.to(x.scalar_type()) : Tensor();
  return torch::conv2d(x, layer.weight.to(x.scalar_type()), bias, /*stride=*/1,
                       layer.options.kernel_size()->front() / 2);
}

Tensor twice(const Tensor& x) {
  return nn::functional::interpolate(x, nn::functional::InterpolateFuncOptions()
                                            .scale_factor(std::vector<double>{2, 2})
                                            .mode(torch::kNearest));
}

}  // namespace

BlockImpl::BlockImpl(int in, int out, int count) {
  for (int i = 0; i < count; ++i) {
    layers->push_back(
        nn::Conv2d(nn::Conv2dOptions(i == 0 ? in : out, out, 3).padding(1).bias(false)));
    layers->push_back(nn::BatchNorm2d(out));
  }
  register_module("layers", layers);
}

Tensor BlockImpl::forward(Tensor x, const Watch& watch) {
  for (std::size_t i = 0; i < layers->size(); i += 2) {
    x = convolve(*layers[i]->as<nn::Conv2d>(), x);
    auto* const norm = layers[i + 1]->as<nn::BatchNorm2d>();
    if (watch) watch(*norm, x);
    x = torch::relu(norm->forward(x));
  }
  return x;
}

NetworkImpl::NetworkImpl(const NetworkConfig& wanted) : config(wanted) {
  const auto& c = config;
  down_fine = register_module("down_fine", Block(kFold * field::kPlanes, c.fine, 2));
  down_middle = register_module("down_middle", Block(c.fine, c.middle, 2));
  coarse = register_module("coarse", Block(c.middle, c.coarse, 3));
  to_middle = register_module("to_middle", pointwise(c.coarse, c.middle));
  up_middle = register_module("up_middle", Block(c.middle, c.middle, 2));
  to_fine = register_module("to_fine", pointwise(c.middle, c.fine));
  up_fine = register_module("up_fine", Block(c.fine, c.fine, 2));
  head = register_module("head", pointwise(c.fine, kFold * field::kChannels));
  const torch::NoGradGuard no_gradients;
  head->bias.zero_();
  const auto start = [&](field::Channel channel, double value) {
    head->bias.slice(0, kFold * channel, kFold * (channel + 1)).fill_(value);
  };
  start(field::kCentre, -3);  // rare things are rare from the start
  start(field::kTip, -5);
  start(field::kUnder, -5);
  start(field::kRope, -2);
  start(field::kEdge, -4);
}

Tensor NetworkImpl::forward(const Tensor& planes, const Watch& watch) {
  // A place's channels lie side by side: libtorch convolves that in half the time.
  const Tensor places =
      torch::pixel_unshuffle(planes, 2).contiguous(torch::MemoryFormat::ChannelsLast);
  const Tensor fine = down_fine->forward(places, watch);
  const Tensor middle = down_middle->forward(torch::max_pool2d(fine, 2), watch);
  const Tensor bottom = coarse->forward(torch::max_pool2d(middle, 2), watch);
  const Tensor half = up_middle->forward(middle + twice(convolve(*to_middle, bottom)), watch);
  const Tensor whole = up_fine->forward(fine + twice(convolve(*to_fine, half)), watch);
  return torch::pixel_shuffle(convolve(*head, whole), 2).to(torch::kFloat32).contiguous();
}

}  // namespace flowdlo::strand
