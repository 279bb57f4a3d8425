// Trainer: the run that a strand field learns in, and the loop that lowers its loss.
#pragma once

#include <torch/torch.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "strand/loss.hpp"
#include "strand/network.hpp"
#include "strand/patch_store.hpp"
#include "strand/recipe.hpp"
#include "weights/field_weights.hpp"

namespace flowdlo::strand {

/// All that a run is, apart from its patches.
struct State {
  Recipe recipe;
  std::int64_t step = 0;
  Network network{nullptr};
  Network average{nullptr};  ///< what is exported
  std::unique_ptr<torch::optim::AdamW> optimizer;
  std::string command;  ///< and on what it ran, for the metadata
};

[[nodiscard]] State start(const Recipe& recipe, torch::Device device);

/// A new run that begins with what `earlier` has learned on average. Fails with kBadInput where its
/// network has other sizes.
[[nodiscard]] Result<State> start_from(const State& earlier, const Recipe& recipe,
                                       torch::Device device);

/// The same from exported weights. Folding has taken the batch norms' statistics away: they are
/// measured anew on samples of `patches`. Fails likewise, and as PatchStore::read does.
[[nodiscard]] Result<State> start_from(const weights::FieldWeights& earlier,
                                       const PatchStore& patches, const Recipe& recipe,
                                       torch::Device device);

/// Under a temporary name, then renamed. Fails with kIo.
[[nodiscard]] Result<void> save_checkpoint(const State& state, const std::filesystem::path& file);
/// Fails with kIo, or kBadInput where the file is no checkpoint of a strand field.
[[nodiscard]] Result<State> load_checkpoint(const std::filesystem::path& file,
                                            torch::Device device);

struct RunOptions {
  std::filesystem::path folder;   ///< of the checkpoint and steps.csv
  std::filesystem::path patches;  ///< of shards; new ones are taken up at every checkpoint
  int threads = 1;                ///< that make samples beside the optimiser
  std::int64_t stop_after = 0;    ///< steps of this call; 0: to the recipe's end
  std::function<void(const std::string& line)> on_note;
};

/// Trains `state` up to the recipe's last step. The samples of a step depend on the recipe, the
/// step and the patches that are there. Fails with kIo or kBadInput, or with kInternal when the
/// loss stops being finite.
[[nodiscard]] Result<void> train(State& state, const RunOptions& options, torch::Device device);

}  // namespace flowdlo::strand
