// Evaluator: runs the estimator on frames with truth.
#pragma once

#include <filesystem>
#include <string>

#include "eval/contenders.hpp"
#include "eval/trial.hpp"
#include "flowdlo/estimator.hpp"
#include "flowdlo/frame_folder.hpp"

namespace flowdlo::eval {

/// `config` with the K and D that `estimator`, made of it, runs: those that its quality stands for.
[[nodiscard]] Config in_full(const Config& config, const Estimator& estimator);

/// One estimator for the estimate and one a kind of prior, and the contenders asked for. One
/// instance a thread.
class Evaluator {
 public:
  /// Fails as Estimator::create and Contenders::create do.
  [[nodiscard]] static Result<Evaluator> create(const Config& config,
                                                const ContenderConfig& contenders = {});

  /// Never fails: what goes wrong with a frame stands in Trial::failure and costs its row only.
  [[nodiscard]] Trial run(const std::filesystem::path& folder, const std::string& name);

  /// The same, of a frame that comes from elsewhere; `path` counts as its place in its data set.
  [[nodiscard]] Trial run(const Result<FrameFolder>& frame, const Result<SceneInfo>& scene,
                          const std::filesystem::path& path, const std::string& name);

  [[nodiscard]] const Estimator& estimator() const { return estimator_; }

 private:
  Evaluator(Estimator estimator, Estimator thesis, Estimator refined, Contenders contenders);
  void run_own(const FrameFolder& folder, Trial& trial);

  Estimator estimator_;
  Estimator thesis_;
  Estimator refined_;
  Contenders contenders_;
};

}  // namespace flowdlo::eval
