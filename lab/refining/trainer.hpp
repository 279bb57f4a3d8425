// Trainer: the refining network on libtorch, its loss, and the loop that lowers it.
#pragma once

#include <torch/torch.h>

#include <functional>
#include <string>
#include <vector>

#include "refining/recipe.hpp"
#include "refining/strip_store.hpp"
#include "weights/refine_weights.hpp"

namespace flowdlo::refining {

class NetworkImpl : public torch::nn::Module {
 public:
  NetworkImpl();

  /// [n, kStations, kRefineInputs] to [n, kNodes, 3]: deep and aside, radii, and the logit of the
  /// share of the way to the table.
  torch::Tensor forward(const torch::Tensor& strips);

  torch::nn::Conv2d stem{nullptr};
  torch::nn::ModuleList squares;
  torch::nn::Conv2d head{nullptr};
};
TORCH_MODULE(Network);

/// As the engine reads it.
[[nodiscard]] weights::RefineWeights exported(const Network& network, const std::string& notes);

struct Trained {
  Network network{nullptr};  ///< the average over the last steps, on the CPU
  std::string table;         ///< Markdown: errors before and after, of scenes that were held out
};

/// Trains on four of five scenes, on `device`. Fails with kBadInput where fewer than ten strips are
/// left, with kInternal where the loss stops being finite.
[[nodiscard]] Result<Trained> train(const Recipe& recipe, const std::vector<StripSample>& samples,
                                    torch::Device device,
                                    const std::function<void(const std::string&)>& on_note);

}  // namespace flowdlo::refining
