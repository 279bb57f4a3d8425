// Objective: Sec. 3.5 of the thesis, and the robust one that weighs clean-state errors evenly.
#pragma once

#include <torch/torch.h>

#include "train/recipe.hpp"

namespace flowdlo::train {

/// What one batch's loss reads; normalised units, B samples.
struct Target {
  torch::Tensor state;   ///< [B, 64, 3] x_t
  torch::Tensor time;    ///< [B] t
  torch::Tensor prior;   ///< [B, 64, 3]
  torch::Tensor truth;   ///< [B, 64, 3] x_1
  torch::Tensor source;  ///< [B, 64, 3] x_0
  torch::Tensor norm;    ///< [B, 4] mean and scale, metres
};

/// Scalars; `total` is what is minimised, the others are before their weights.
struct Losses {
  torch::Tensor total;
  torch::Tensor primary;  ///< velocity, Smooth L1 or pseudo-Huber
  torch::Tensor spacing;  ///< Eq. (3.21)
  torch::Tensor bending;  ///< Eq. (3.24)
  torch::Tensor harm;
  torch::Tensor sigma;
  torch::Tensor prior;  ///< what `primary` would be for the prior itself; robust alone, else 0
};

/// Mean squared error of the velocity, Eq. (3.17).
[[nodiscard]] torch::Tensor velocity_loss(const torch::Tensor& velocity, const torch::Tensor& truth,
                                          const torch::Tensor& source);

/// Eq. (3.21) for curves [B, 64, 3] in any unit.
[[nodiscard]] torch::Tensor spacing_loss(const torch::Tensor& nodes, const torch::Tensor& truth);

/// Eq. (3.24) for curves [B, 64, 3].
[[nodiscard]] torch::Tensor bending_loss(const torch::Tensor& nodes);

/// Smooth L1 with beta 0.02 m, mean over coordinates; both [B, 64, 3] in metres. Sec. 3.5.
[[nodiscard]] torch::Tensor direct_loss(const torch::Tensor& nodes_m, const torch::Tensor& truth_m);

/// [B] mean over nodes of delta (sqrt(1 + |e|^2 / delta^2) - 1): |e|^2 / 2 delta near zero, |e|
/// beyond.
[[nodiscard]] torch::Tensor huber_loss(const torch::Tensor& nodes, const torch::Tensor& truth,
                                       double delta);

/// [B] mean over nodes of how much farther from the truth a node is than its prior; 0 where it is
/// not.
[[nodiscard]] torch::Tensor harm_loss(const torch::Tensor& nodes, const torch::Tensor& prior,
                                      const torch::Tensor& truth);

/// [B] what a record weighs, ObjectiveConfig::balance; at most 1.
[[nodiscard]] torch::Tensor record_weight(const torch::Tensor& prior, const torch::Tensor& truth,
                                          double balance);

/// Mean negative log-likelihood, up to a constant, of node errors under a 3D Student t of scale
/// exp(log_sigma) [B, 64] and four degrees of freedom. Errors pass no gradient to the nodes.
[[nodiscard]] torch::Tensor sigma_loss(const torch::Tensor& log_sigma, const torch::Tensor& nodes,
                                       const torch::Tensor& truth);

/// The clean state that the head's output stands for, Eq. (3.18), or the output itself when direct.
[[nodiscard]] torch::Tensor clean_state(const weights::Variant& variant,
                                        const torch::Tensor& output, const Target& target);

/// Eq. (3.25) or its robust counterpart; `output` [B, 64, 3 or 4] is the head's.
[[nodiscard]] Losses objective(const weights::Variant& variant, const ObjectiveConfig& config,
                               const torch::Tensor& output, const Target& target);

}  // namespace flowdlo::train
