// TrainingState: everything that a run changes, and its checkpoint on disk.
#pragma once

#include <torch/torch.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "flowdlo/result.hpp"
#include "train/recipe.hpp"
#include "train/record_view.hpp"
#include "train/velocity_model.hpp"

namespace flowdlo::train {

inline constexpr std::size_t kHeadGroup = 2;  ///< of the optimiser's parameter groups

struct TrainingState {
  Recipe recipe;
  std::string command;      ///< that started the run, for the metadata
  std::string data_sha256;  ///< of the training records last used
  std::string data_origin;
  std::string device;        ///< in words
  std::string validation;    ///< the last validation table, Markdown
  std::int64_t step = 0;     ///< optimiser steps done
  std::uint32_t shards = 0;  ///< of training records in use
  GlobalNorm norm;           ///< of the records at the start of the run
  VelocityModel model{nullptr};
  VelocityModel average{nullptr};  ///< EMA of the model's parameters; null without one
  std::unique_ptr<torch::optim::AdamW> optimizer;

  /// What validation and export use.
  [[nodiscard]] VelocityModelImpl& best() const { return average ? *average.ptr() : *model.ptr(); }
};

/// Parameters drawn from recipe.seed; head zero, so that a preconditioned model starts as its
/// prior.
[[nodiscard]] TrainingState start(const Recipe& recipe, torch::Device device);

/// Under a temporary name, then renamed. Fails with kIo.
[[nodiscard]] Result<void> save_checkpoint(const TrainingState& state,
                                           const std::filesystem::path& file);

/// Fails with kIo, or kBadInput when the file is no checkpoint of this program.
[[nodiscard]] Result<TrainingState> load_checkpoint(const std::filesystem::path& file,
                                                    torch::Device device);

/// Goes on with `recipe`: sampling, objective, schedule, rates and steps are the new ones; the
/// model, what the optimiser has gathered and its decays stay. Fails with kBadInput when `recipe`
/// is of another model.
[[nodiscard]] Result<void> take_recipe(TrainingState& state, const Recipe& recipe);

}  // namespace flowdlo::train
