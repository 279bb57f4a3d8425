// Evaluator: runs the estimator on frames with truth.
#pragma once

#include <filesystem>
#include <string>

#include "eval/trial.hpp"
#include "flowdlo/estimator.hpp"

namespace flowdlo::eval {

/// One estimator for the estimate and one a kind of prior. One instance a thread.
class Evaluator {
 public:
  /// Fails as Estimator::create does.
  [[nodiscard]] static Result<Evaluator> create(const Config& config);

  /// Never fails: what goes wrong with a frame stands in Trial::failure and costs its row only.
  [[nodiscard]] Trial run(const std::filesystem::path& folder, const std::string& name);

  [[nodiscard]] const Estimator& estimator() const { return estimator_; }

 private:
  Evaluator(Estimator estimator, Estimator thesis, Estimator refined);

  Estimator estimator_;
  Estimator thesis_;
  Estimator refined_;
};

}  // namespace flowdlo::eval
