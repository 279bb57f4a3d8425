// Batch: training samples side by side as tensors.
#pragma once

#include <torch/torch.h>

#include <span>
#include <vector>

#include "train/objective.hpp"
#include "train/record_view.hpp"
#include "train/sample_plan.hpp"
#include "train/velocity_model.hpp"

namespace flowdlo::train {

struct Batch {
  ModelInput input;
  Target target;

  [[nodiscard]] Batch to(torch::Device device) const;
};

/// The conditions of `views` without state: prior, support, points, valid; f32 on the CPU.
[[nodiscard]] ModelInput conditions_of(std::span<const RecordView> views);

/// phi_M of normalised states [B, 64, 3] f32 on the CPU: [B, 64, channels].
[[nodiscard]] torch::Tensor features_of(std::span<const RecordView> views,
                                        const torch::Tensor& state, int channels);

/// Rows [R, 4] of each view side by side, the first `columns` of them: [B, R, columns].
[[nodiscard]] torch::Tensor stacked(std::span<const RecordView> views,
                                    std::span<const float> (RecordView::*rows)() const,
                                    std::int64_t columns);

/// One step's batch: x_t = (1 - t) x_0 + t x_1, Eq. (2.4).
[[nodiscard]] Batch make_batch(std::span<const Record> records, const SamplePlan& plan,
                               const ViewConfig& view, std::uint64_t step, int size,
                               int local_channels);

}  // namespace flowdlo::train
