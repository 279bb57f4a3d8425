// TrainingLog: the run as two CSV files that a resumed run continues.
#pragma once

#include <filesystem>
#include <fstream>
#include <vector>

#include "flowdlo/result.hpp"
#include "train/validation.hpp"

namespace flowdlo::train {

struct StepReport {
  std::int64_t step = 0;
  double total = 0;
  double primary = 0;
  double prior = 0;  ///< `primary` of the prior itself
  double spacing = 0;
  double bending = 0;
  double harm = 0;
  double sigma = 0;
  double rate = 0;           ///< learning rate
  double gradient_norm = 0;  ///< before clipping
  double records_per_s = 0;
  std::uint64_t records = 0;  ///< in use
};

class TrainingLog {
 public:
  /// steps.csv and validation.csv in `folder`; rows after `step` of an earlier run are dropped.
  [[nodiscard]] static Result<TrainingLog> open(const std::filesystem::path& folder,
                                                std::int64_t step);

  void add(const StepReport& report);
  void add(std::int64_t step, const std::vector<GroupErrors>& groups);

 private:
  std::ofstream steps_;
  std::ofstream validation_;
};

}  // namespace flowdlo::train
