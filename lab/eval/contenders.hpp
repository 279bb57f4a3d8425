// Contenders: baselines and other models, run on the frames of an evaluation.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "baselines/baseline.hpp"
#include "eval/trial.hpp"
#include "flowdlo/estimator.hpp"
#include "flowdlo/frame_folder.hpp"

namespace flowdlo::eval {

struct ContenderConfig {
  std::vector<std::string> baselines;  ///< names, or "all"
  /// Folder of NAME.fdw; empty: none. Those named full, no-points, direct and residual are the
  /// columns of the thesis' tables, and full and direct run at 1, 4, 10 and 20 steps. With models,
  /// the evaluated one and full return by either gate that their weights know, too: gate-thesis,
  /// full.gate-calibrated, ...
  std::filesystem::path models;
};

/// What rows depend on through `contenders`: baselines by name, models by the sum of their tensors.
/// Fails with kBadInput and as inspect_weights does.
[[nodiscard]] Result<std::map<std::string, std::string>> settings_of(
    const ContenderConfig& contenders);

/// The steps of Table 4.5.
inline constexpr int kSweep[] = {1, 4, 10, 20};

/// "full@4": the method of model `name` at `steps` steps.
[[nodiscard]] std::string swept(const std::string& name, int steps);

class Contenders {
 public:
  /// `config`: device, draws, seed and steps of the models; their priors are those they were
  /// trained on. Fails with kBadInput for unknown baselines or a folder without a model, and as
  /// Estimator::create does.
  [[nodiscard]] static Result<Contenders> create(const Config& config,
                                                 const ContenderConfig& contenders);

  /// Adds methods, accounts and curves. A contender that fails costs its own cell only.
  void run(const FrameFolder& folder, Trial& trial);

 private:
  struct Model {
    std::vector<std::string> methods;  ///< a model at the steps of the run has two names
    std::string returned;              ///< the method of its estimates; empty: not asked for
    Estimator estimator;
  };

  Result<void> add_model(const Config& config, const std::string& name, bool sweeps);
  Result<void> add_gates(const Config& config, const std::string& part);

  std::vector<const baselines::Baseline*> baselines_;
  std::vector<Model> models_;
};

}  // namespace flowdlo::eval
