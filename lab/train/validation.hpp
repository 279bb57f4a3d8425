// Validation: the model's index error beside its prior's, by difficulty.
#pragma once

#include <torch/torch.h>

#include <span>
#include <string>
#include <vector>

#include "train/record_view.hpp"
#include "train/velocity_model.hpp"

namespace flowdlo::train {

/// Means over the records of one group. Errors are Eq. (4.1) against the truth in the direction
/// that fits the prior; records where that is not the canonical one are counted as flips.
struct GroupErrors {
  std::string group;  ///< "all", "easy", "middle", "hard", or a scenario
  int records = 0;
  double prior_cm = 0;
  double model_cm = 0;
  double prior_median_cm = 0;
  double model_median_cm = 0;
  double prior_over = 0;  ///< share of records over 2 cm
  double model_over = 0;
  double harmed = 0;  ///< share that the model makes worse by more than 1 mm
  int flips = 0;

  [[nodiscard]] double ratio() const { return prior_cm > 0 ? model_cm / prior_cm : 1; }
};

/// Nodes [B, 64, 3] after K Euler steps, Eq. (3.26)-(3.29), normalised, f32 on the CPU. `source`
/// [B, 64, 3] is x_0. The sampler of the engine a second time, for many records at once.
[[nodiscard]] torch::Tensor sample(VelocityModelImpl& model, std::span<const RecordView> views,
                                   const torch::Tensor& source, int steps,
                                   torch::ScalarType compute, torch::Device device);

/// One draw a record from the engine's source of seed 0, best prior, unturned.
[[nodiscard]] std::vector<GroupErrors> validate_model(VelocityModelImpl& model,
                                                      std::span<const Record> records,
                                                      const ViewConfig& view, int steps,
                                                      torch::ScalarType compute,
                                                      torch::Device device);

/// A Markdown table.
[[nodiscard]] std::string table_of(const std::vector<GroupErrors>& groups);

}  // namespace flowdlo::train
