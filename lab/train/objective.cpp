#include "train/objective.hpp"

#include "train/velocity_model.hpp"

namespace flowdlo::train {
namespace {

using torch::Tensor;

constexpr double kTiny = 1e-12;

/// Length along the last dimension, with a gradient at zero.
Tensor length(const Tensor& x) { return (x.square().sum(-1) + kTiny).sqrt(); }

/// [B, 63, 3] X_{i+1} - X_i.
Tensor segments(const Tensor& nodes) {
  const auto count = nodes.size(1);
  return nodes.narrow(1, 1, count - 1) - nodes.narrow(1, 0, count - 1);
}

Tensor in_metres(const Tensor& nodes, const Tensor& norm) {  // Norm^-1, Eq. (3.10)
  return nodes * norm.narrow(1, 3, 1).unsqueeze(1) + norm.narrow(1, 0, 3).unsqueeze(1);
}

Tensor primary_loss(const weights::Variant& variant, const ObjectiveConfig& config,
                    const Tensor& output, const Tensor& clean, const Tensor& weight,
                    const Target& target) {
  if (config.kind == ObjectiveKind::kRobust) {
    return (huber_loss(clean, target.truth, config.huber_delta) * weight).mean();
  }
  if (variant.parameterization == ops::Parameterization::kDirect) {
    return direct_loss(in_metres(clean, target.norm), in_metres(target.truth, target.norm));
  }
  return velocity_loss(velocity(variant, output, target.state, target.time, target.prior),
                       target.truth, target.source);
}

}  // namespace

Tensor velocity_loss(const Tensor& velocity, const Tensor& truth, const Tensor& source) {
  return (velocity - (truth - source)).square().mean();  // Eq. (3.17)
}

Tensor spacing_loss(const Tensor& nodes, const Tensor& truth) {
  const Tensor predicted = length(segments(nodes));                           // Eq. (3.19)
  const Tensor mean = segments(truth).norm(2, -1).mean(1, /*keepdim=*/true);  // Eq. (3.20)
  return ((predicted - mean).abs() / mean.clamp_min(1e-9)).mean();            // Eq. (3.21)
}

Tensor bending_loss(const Tensor& nodes) {
  const Tensor all = segments(nodes);
  const auto count = all.size(1);
  const Tensor before = all.narrow(1, 0, count - 1);  // Eq. (3.22)
  const Tensor after = all.narrow(1, 1, count - 1);
  const Tensor cosine = (before * after).sum(-1) / (length(before) * length(after));  // Eq. (3.23)
  return torch::relu(-cosine).square().mean();                                        // Eq. (3.24)
}

Tensor direct_loss(const Tensor& nodes_m, const Tensor& truth_m) {
  constexpr double kBeta_m = 0.02;
  return torch::smooth_l1_loss(nodes_m, truth_m, at::Reduction::Mean, kBeta_m);
}

Tensor huber_loss(const Tensor& nodes, const Tensor& truth, double delta) {
  const Tensor square = (nodes - truth).square().sum(-1);
  return (delta * ((1 + square / (delta * delta)).sqrt() - 1)).mean(1);
}

Tensor harm_loss(const Tensor& nodes, const Tensor& prior, const Tensor& truth) {
  return torch::relu(length(nodes - truth) - length(prior - truth)).mean(1);
}

Tensor record_weight(const Tensor& prior, const Tensor& truth, double balance) {
  const Tensor error = (prior - truth).norm(2, -1).mean(1);
  return (kBalanceFloor / (error + kBalanceFloor)).pow(balance);
}

Tensor sigma_loss(const Tensor& log_sigma, const Tensor& nodes, const Tensor& truth) {
  constexpr double kFreedom = 4;
  constexpr double kDimensions = 3;
  constexpr double kLimit = 12;  // e^-12 of the rope's size is beyond any sensor
  const Tensor bounded = log_sigma.clamp(-kLimit, kLimit);
  const Tensor square = (nodes.detach() - truth).square().sum(-1);
  const Tensor tail = torch::log1p(square * torch::exp(-2 * bounded) / kFreedom);
  return (kDimensions * bounded + 0.5 * (kFreedom + kDimensions) * tail).mean();
}

Tensor clean_state(const weights::Variant& variant, const Tensor& output, const Target& target) {
  if (variant.parameterization == ops::Parameterization::kDirect) return output.narrow(-1, 0, 3);
  const Tensor t = target.time.view({-1, 1, 1});
  return target.state + (1 - t) * velocity(variant, output, target.state, target.time,
                                           target.prior);  // Eq. (3.18)
}

Losses objective(const weights::Variant& variant, const ObjectiveConfig& config,
                 const Tensor& output, const Target& target) {
  const Tensor clean = clean_state(variant, output, target);
  Losses losses;
  const Tensor weight = record_weight(target.prior, target.truth, config.balance);
  losses.primary = primary_loss(variant, config, output, clean, weight, target);
  losses.spacing = spacing_loss(clean, target.truth);
  losses.bending = bending_loss(clean);
  losses.harm = (harm_loss(clean, target.prior, target.truth) * weight).mean();
  losses.total = losses.primary + config.spacing * losses.spacing + config.bending * losses.bending;
  if (config.harm > 0) losses.total = losses.total + config.harm * losses.harm;
  losses.sigma = torch::zeros_like(losses.primary);
  losses.prior = losses.sigma;
  if (config.kind == ObjectiveKind::kRobust) {
    losses.prior = (huber_loss(target.prior, target.truth, config.huber_delta) * weight).mean();
  }
  if (variant.head_channels == 4) {
    losses.sigma = sigma_loss(output.select(-1, 3), clean, target.truth);
    if (config.sigma > 0) losses.total = losses.total + config.sigma * losses.sigma;
  }
  return losses;
}

}  // namespace flowdlo::train
