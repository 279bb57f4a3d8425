// Recipe: everything that decides about the training of the refining network, as one JSON file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "flowdlo/result.hpp"

namespace flowdlo::refining {

/// What strips are made of: wide training scenes [first, first + scenes).
struct DataConfig {
  std::uint64_t first = 3500000;
  std::uint64_t scenes = 3000;  ///< rounded up to whole shards
  double matched = 0.6;  ///< share whose camera matches two pictures, where it is a stereo one
  double seen = 0.25;    ///< share in which the strand field is asked too
  double uneven = 0.25;  ///< share that lies on something wavy, as a cloth (refining/uneven.hpp)
};

struct Schedule {
  int batch = 16;
  int steps = 4000;
  double rate = 2e-3;
  double final_rate = 4e-5;
  int warmup_steps = 50;
  double weight_decay = 0.05;
  double clip_norm = 1;
  double ema_decay = 0.997;
  double matched_weight = 2;  ///< how often a strip with matched depth is drawn, beside others
  double harm = 0.3;          ///< extra weight of what a node gets worse by
  double most_index_mm = 10;  ///< strips with an index error above it are left out,
  double most_deep_mm = 10;   ///< but not up to this where nodes are off deep rather than aside
};

struct Recipe {
  std::string name;
  std::uint64_t seed = 0;
  DataConfig data;
  Schedule schedule;
};

/// Every key may be left out, none may be unknown. Fails with kBadInput, listing every fault.
[[nodiscard]] Result<Recipe> parse_recipe(const std::string& json, const std::string& where);
[[nodiscard]] Result<Recipe> read_recipe(const std::filesystem::path& file);

}  // namespace flowdlo::refining
