// Trainer: the optimisation loop.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "flowdlo/result.hpp"
#include "train/batch.hpp"
#include "train/training_log.hpp"
#include "train/training_state.hpp"

namespace flowdlo::train {

struct RunOptions {
  std::filesystem::path folder;   ///< of checkpoints, logs and curves
  std::filesystem::path records;  ///< of shards
  int loader_threads = 1;
  bool grow = true;                                ///< take up new shards at every checkpoint
  std::int64_t stop_after = 0;                     ///< steps of this call; 0: to the recipe's end
  std::function<void(const StepReport&)> on_step;  ///< may be empty
  std::function<void(const std::string& line)> on_note;  ///< a sentence for the log
};

/// The learning rate of a step: linear warm-up, then a cosine from rate to final_rate.
[[nodiscard]] double learning_rate(const OptimizerConfig& config, std::int64_t step);

/// EMA's decay at a step: smaller at first, so that the start is soon forgotten.
[[nodiscard]] double average_decay(double decay, std::int64_t step);

/// One optimiser step on one batch; `state.step` advances.
[[nodiscard]] StepReport train_step(TrainingState& state, const Batch& batch);

/// Trains `state` on the records of `options` up to the recipe's last step. Writes
/// folder/checkpoint.pt, steps.csv, validation.csv, curves.png. Fails with kIo or kBadInput, or
/// with kInternal when the loss stops being finite.
[[nodiscard]] Result<void> train(TrainingState& state, const RunOptions& options,
                                 torch::Device device);

}  // namespace flowdlo::train
