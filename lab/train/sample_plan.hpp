// SamplePlan: which record, prior, turn, time and source a training sample has. A pure function of
// seed, step and slot: a run that is resumed sees what it would have seen.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "train/recipe.hpp"
#include "train/record_view.hpp"

namespace flowdlo::train {

struct Choice {
  std::size_t record = 0;
  std::size_t prior = 0;
  Turn turn;
  float t = 0;                 ///< in [0, 1)
  bool on_prior_path = false;  ///< the state lies on the way to the prior, not to the truth
  std::uint64_t source = 0;    ///< stream of the Gaussian source x_0
};

class SamplePlan {
 public:
  SamplePlan(std::span<const Record> records, const SamplingConfig& config, std::uint64_t seed);

  [[nodiscard]] Choice choose(std::uint64_t step, int slot, int batch) const;

  /// x_0 [64, 4], column 3 zero.
  void source(const Choice& choice, std::span<float> state) const;

 private:
  std::span<const Record> records_;
  SamplingConfig config_;
  std::uint64_t seed_;
  std::vector<double> cumulative_;  // of the records' weights
};

}  // namespace flowdlo::train
