// Recipe: everything that decides about the training of a strand field, as one JSON file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "flowdlo/result.hpp"
#include "strand/patch_store.hpp"
#include "strand/sample.hpp"
#include "train/precision.hpp"

namespace flowdlo::strand {

struct NetworkConfig {
  int fine = 32;    ///< channels at half the region's size,
  int middle = 48;  ///< at a quarter,
  int coarse = 96;  ///< and at an eighth
};

struct LossConfig {  ///< weights of the parts
  double centre = 10;
  double direction = 0.3;
  double tip = 10;
  double under = 5;
  double width = 0.3;
  double rope = 0.5;
  double edge = 2;
};

struct Schedule {
  int batch = 12;
  int size_px = 128;  ///< of a sample's side
  int steps = 6000;
  double rate = 3e-3;
  double final_rate = 2e-5;
  int warmup_steps = 100;
  double weight_decay = 1e-3;
  double clip_norm = 5;
  double ema_decay = 0.998;
  int checkpoint_every = 200;
  train::Precision precision = train::Precision::kBf16;  ///< of the convolutions
};

struct Recipe {
  std::string name;
  std::uint64_t seed = 0;
  NetworkConfig network;
  DataConfig data;
  SpoilConfig spoil;
  LossConfig loss;
  Schedule schedule;
};

/// Every key may be left out, none may be unknown. Fails with kBadInput, listing every fault.
[[nodiscard]] Result<Recipe> parse_recipe(const std::string& json, const std::string& where);
[[nodiscard]] Result<Recipe> read_recipe(const std::filesystem::path& file);

/// The whole recipe, defaults included; parse_recipe gives the same recipe back.
[[nodiscard]] std::string to_json(const Recipe& recipe);

}  // namespace flowdlo::strand
