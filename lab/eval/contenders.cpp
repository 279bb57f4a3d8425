#include "eval/contenders.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <system_error>

#include "eval/draws.hpp"
#include "flowdlo/weights.hpp"
#include "gate/gate.hpp"

namespace flowdlo::eval {
namespace {

namespace fs = std::filesystem;

Result<std::vector<fs::path>> weights_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code failure;
  for (const auto& entry : fs::directory_iterator(folder, failure)) {
    if (entry.path().extension() == ".fdw") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  if (!files.empty()) return files;
  return Error{ErrorCode::kBadInput,
               fmt::format("--models {}: expected a folder of NAME.fdw, got {}; train the models "
                           "first (docs/training.md)",
                           folder.string(), failure ? failure.message() : "none")};
}

bool is_swept(const std::string& name) { return name == "full" || name == "direct"; }

void run_baseline(const baselines::Baseline& baseline, const baselines::Observation& seen,
                  const gate::DilatedMask& mask, Trial& trial) {
  const baselines::Attempt attempt = baseline.run(seen);
  Account& account = trial.accounts[baseline.name];
  account = {};
  account.failure = attempt.reason;
  account.output = attempt.status != baselines::Status::kNoOutput;
  if (!account.valid()) return;
  account.mask_agreement =
      static_cast<double>(mask.agreement(attempt.nodes, seen.folder.intrinsics));
  trial.curves[baseline.name] = {kept(attempt.nodes)};
  if (!seen.folder.truth) return;
  trial.methods[baseline.name] = baseline.either_way
                                     ? either_way(attempt.nodes, *seen.folder.truth)
                                     : mean_of({score(attempt.nodes, *seen.folder.truth)});
}

}  // namespace

std::string swept(const std::string& name, int steps) { return fmt::format("{}@{}", name, steps); }

Result<std::map<std::string, std::string>> settings_of(const ContenderConfig& contenders) {
  std::map<std::string, std::string> settings;
  const auto chosen = baselines::choose_baselines(contenders.baselines);
  if (!chosen) return chosen.error();
  for (const baselines::Baseline* baseline : *chosen) {
    settings[fmt::format("baseline {}", baseline->name)] = "on";
  }
  if (contenders.models.empty()) return settings;
  const auto files = weights_in(contenders.models);
  if (!files) return files.error();
  for (const fs::path& file : *files) {
    const auto info = inspect_weights(file);
    if (!info) return info.error();
    settings[fmt::format("model {}", file.stem().string())] = info->sha256;
  }
  return settings;
}

Result<Contenders> Contenders::create(const Config& config, const ContenderConfig& contenders) {
  Contenders result;
  auto chosen = baselines::choose_baselines(contenders.baselines);
  if (!chosen) return chosen.error();
  result.baselines_ = *std::move(chosen);
  if (contenders.models.empty()) return result;
  const auto files = weights_in(contenders.models);
  if (!files) return files.error();
  for (const fs::path& file : *files) {
    Config one = config;
    one.weights = file;
    one.prior = PriorChoice::kOfWeights;
    const std::string name = file.stem().string();
    if (auto added = result.add_model(one, name, is_swept(name)); !added) return added.error();
    if (name != "full") continue;
    if (auto added = result.add_gates(one, "full."); !added) return added.error();
  }
  if (auto added = result.add_gates(config, ""); !added) return added.error();
  return result;
}

Result<void> Contenders::add_model(const Config& config, const std::string& name, bool sweeps) {
  std::vector<int> steps_of{config.euler_steps};
  if (sweeps) steps_of.insert(steps_of.end(), std::begin(kSweep), std::end(kSweep));
  std::sort(steps_of.begin(), steps_of.end());
  steps_of.erase(std::unique(steps_of.begin(), steps_of.end()), steps_of.end());
  Config one = config;
  for (const int steps : steps_of) {
    one.euler_steps = steps;
    auto estimator = Estimator::create(one);
    if (!estimator) return estimator.error();
    Model model{{}, {}, *std::move(estimator)};
    if (steps == config.euler_steps) model.methods.push_back(name);
    if (sweeps) model.methods.push_back(swept(name, steps));
    models_.push_back(std::move(model));
  }
  return {};
}

Result<void> Contenders::add_gates(const Config& config, const std::string& part) {
  const auto info = inspect_weights(config.weights);
  if (!info) return info.error();
  Config one = config;
  for (const GateChoice gate : {GateChoice::kThesis, GateChoice::kCalibrated}) {
    if (gate == GateChoice::kCalibrated && info->metadata.count("calibration") == 0) continue;
    one.gate = gate;
    auto estimator = Estimator::create(one);
    if (!estimator) return estimator.error();
    const char* name = gate == GateChoice::kThesis ? "gate-thesis" : "gate-calibrated";
    models_.push_back({{}, part + name, *std::move(estimator)});
  }
  return {};
}

void Contenders::run(const FrameFolder& folder, Trial& trial) {
  if (!baselines_.empty()) {
    const auto seen = baselines::observe(folder, trial.folder);
    const gate::DilatedMask mask(folder.frame());
    for (const baselines::Baseline* baseline : baselines_) {
      if (seen) {
        run_baseline(*baseline, *seen, mask, trial);
      } else {
        trial.accounts[baseline->name].failure = seen.error().message;
      }
    }
  }
  for (Model& model : models_) {
    Tensors tensors;
    const auto estimate = model.estimator.estimate(folder.frame(), tensors);
    if (estimate && folder.truth && !model.returned.empty()) {
      trial.methods[model.returned] = mean_of({score(estimate->nodes, *folder.truth)});
    }
    for (const std::string& method : model.methods) {
      if (!estimate) {
        trial.accounts[method].failure = name_of(estimate.error().code);
        continue;
      }
      add_draws(*estimate, tensors, method, trial);
      if (folder.truth) add_draw_scores(*estimate, tensors, *folder.truth, method, trial);
    }
  }
}

}  // namespace flowdlo::eval
