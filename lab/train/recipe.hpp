// Recipe: everything that decides about a training run, as one JSON file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "flowdlo/result.hpp"
#include "train/precision.hpp"
#include "train/record.hpp"
#include "train/scene_source.hpp"
#include "weights/variant.hpp"

namespace flowdlo::train {

/// Which end of the truth comes first: its own canonical one, or the one that fits the prior.
enum class TruthDirection { kCanonical, kPrior };

struct SamplingConfig {
  double intersection_weight = 2;  ///< Sec. 4.1.3
  double hard_weight = 1;          ///< of scenes where geometry has to guess
  double wrong_weight = 1;         ///< of scenes whose best prior is wrong: 2 cm off and more
  double alternative_share = 0;    ///< samples conditioned on a runner-up's prior
  double rotation_share = 0.75;    ///< Sec. 4.1.3
  double mirror_share = 0;
  double time_power = 1;  ///< t = u^time_power, u uniform: above 1, more of the early flow
  /// Samples whose state lies between source and prior, not source and truth: where sampling passes
  /// while the model follows a wrong prior, and where nothing but the evidence can tell it so.
  double prior_path_share = 0;
  TruthDirection truth_direction = TruthDirection::kCanonical;
};

enum class ObjectiveKind {
  kThesis,  ///< Eq. (3.25); for direct models the Smooth L1 of Sec. 3.5
  kRobust,  ///< clean-state error weighed evenly over t, pseudo-Huber
};

struct ObjectiveConfig {
  ObjectiveKind kind = ObjectiveKind::kThesis;
  double spacing = 0.02;      ///< lambda_spacing, Sec. 4.1.3
  double bending = 0.01;      ///< lambda_bending, Sec. 4.1.3
  double huber_delta = 0.01;  ///< normalised units
  double harm = 0;            ///< weight of being worse than the prior, node by node
  /// Robust: a record weighs (f / (e + f))^balance, e its prior's error and f kBalanceFloor, so
  /// that the many records whose prior is nearly right are heard beside the few that are far off.
  double balance = 0;
  double sigma = 0;  ///< weight of the log-sigma head's likelihood
};

inline constexpr double kBalanceFloor = 0.01;  ///< normalised units

struct OptimizerConfig {
  int batch = 64;
  int steps = 20000;
  double rate = 3e-4;
  double final_rate = 3e-6;
  double head_rate = 1;  ///< of the head, times `rate`: a small prior_sd needs large outputs
  int warmup_steps = 0;
  double beta1 = 0.9;
  double beta2 = 0.999;
  double epsilon = 1e-8;
  double weight_decay = 0;  ///< of matrices; head, biases, norms, e_j and gamma never decay
  double clip_norm = 0;     ///< of the whole gradient; 0: none
  double ema_decay = 0;     ///< 0: the last weights themselves are exported
  Precision precision = Precision::kBf16;
};

struct DataConfig {
  SourceConfig source;
  std::uint64_t training_scenes = 20000;
  std::uint64_t validation_scenes = 300;
};

struct Schedule {
  int validate_every = 500;
  int checkpoint_every = 250;
  int euler_steps = 10;  ///< K of the validation
};

struct Recipe {
  std::string name;
  std::uint64_t seed = 0;
  weights::Variant variant;
  DataConfig data;
  SamplingConfig sampling;
  ObjectiveConfig objective;
  OptimizerConfig optimizer;
  Schedule schedule;

  [[nodiscard]] RecordOptions record_options() const {
    return {variant.prior_kind, variant.local_channels == 8};
  }
};

/// Every key may be left out, none may be unknown. Fails with kBadInput, listing every fault.
[[nodiscard]] Result<Recipe> parse_recipe(const std::string& json, const std::string& where);
[[nodiscard]] Result<Recipe> read_recipe(const std::filesystem::path& file);

/// The whole recipe, defaults included; parse_recipe gives the same recipe back.
[[nodiscard]] std::string to_json(const Recipe& recipe);

}  // namespace flowdlo::train
