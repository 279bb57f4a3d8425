// Loss: how far what a strand field's network says is from what it should say.
#pragma once

#include <torch/torch.h>

#include <array>

#include "strand/recipe.hpp"

namespace flowdlo::strand {

/// The parts of the loss, each without its weight.
struct LossParts {
  torch::Tensor centre;
  torch::Tensor direction;
  torch::Tensor tip;
  torch::Tensor under;
  torch::Tensor width;
  torch::Tensor rope;
  torch::Tensor edge;

  [[nodiscard]] torch::Tensor total(const LossConfig& weights) const;
};

/// A part by name; LossConfig holds its weight.
struct LossPart {
  const char* name;
  double LossConfig::*weight;
  torch::Tensor LossParts::*value;
};
inline constexpr std::array<LossPart, 7> kLossParts{{
    {"centre", &LossConfig::centre, &LossParts::centre},
    {"direction", &LossConfig::direction, &LossParts::direction},
    {"tip", &LossConfig::tip, &LossParts::tip},
    {"under", &LossConfig::under, &LossParts::under},
    {"width", &LossConfig::width, &LossParts::width},
    {"rope", &LossConfig::rope, &LossParts::rope},
    {"edge", &LossConfig::edge, &LossParts::edge},
}};

/// `output` and `target` [n, kChannels, h, w], `planes` [n, kPlanes, h, w].
[[nodiscard]] LossParts loss_of(const torch::Tensor& output, const torch::Tensor& target,
                                const torch::Tensor& planes);

}  // namespace flowdlo::strand
