#include "train/sample_plan.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "random/philox.hpp"

namespace flowdlo::train {
namespace {

// Streams of the recipe's seed, apart from one another and from scenes.
constexpr std::uint64_t kChoiceStream = 0x5A11;
constexpr std::uint64_t kSourceStream = 0x5A12'0000'0000'0000ULL;
constexpr double kWrong_m = 0.02;

// Of the best prior, in the direction that fits the truth better.
double prior_error_m(const Record& record) {
  Centerline reversed = record.truth;
  std::reverse(reversed.begin(), reversed.end());
  const Centerline& prior = record.priors.front().nodes;
  return std::min(index_error(prior, record.truth), index_error(prior, reversed));
}

double weight_of(const Record& record, const SamplingConfig& config) {
  double weight = 1;
  if (record.intersection) weight *= config.intersection_weight;  // Sec. 4.1.3
  if (record.difficulty == Difficulty::kHard) weight *= config.hard_weight;
  if (config.wrong_weight != 1 && prior_error_m(record) > kWrong_m) weight *= config.wrong_weight;
  return weight;
}

}  // namespace

SamplePlan::SamplePlan(std::span<const Record> records, const SamplingConfig& config,
                       std::uint64_t seed)
    : records_(records), config_(config), seed_(seed) {
  double sum = 0;
  for (const Record& record : records) {
    sum += weight_of(record, config);
    cumulative_.push_back(sum);
  }
}

Choice SamplePlan::choose(std::uint64_t step, int slot, int batch) const {
  Choice choice;
  choice.source = step * static_cast<std::uint64_t>(batch) + static_cast<std::uint64_t>(slot);
  const auto first = random::philox(seed_, 2 * choice.source, kChoiceStream);
  const auto second = random::philox(seed_, 2 * choice.source + 1, kChoiceStream);

  const double target = random::uniform(first[0]) * cumulative_.back();
  const auto found = std::upper_bound(cumulative_.begin(), cumulative_.end(), target);
  choice.record =
      std::min(static_cast<std::size_t>(found - cumulative_.begin()), cumulative_.size() - 1);

  const std::size_t runners_up = records_[choice.record].priors.size() - 1;
  if (runners_up > 0 && random::uniform(first[1]) < config_.alternative_share) {
    choice.prior = 1 + first[2] % runners_up;
  }
  choice.t = std::min(static_cast<float>(std::pow(random::uniform(first[3]), config_.time_power)),
                      0.9999999F);
  if (random::uniform(second[0]) < config_.rotation_share) {
    choice.turn.angle_rad = 2 * std::numbers::pi * random::uniform(second[1]);
  }
  choice.turn.mirrored = random::uniform(second[2]) < config_.mirror_share;
  choice.on_prior_path = random::uniform(second[3]) < config_.prior_path_share;
  return choice;
}

void SamplePlan::source(const Choice& choice, std::span<float> state) const {
  for (std::size_t node = 0; node < kNodes; ++node) {
    const auto values = random::gaussian(seed_, node, kSourceStream + choice.source);
    for (std::size_t axis = 0; axis < 3; ++axis) state[node * 4 + axis] = values[axis];
    state[node * 4 + 3] = 0;
  }
}

}  // namespace flowdlo::train
