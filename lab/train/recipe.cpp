#include "train/recipe.hpp"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "train/json_visitor.hpp"

namespace flowdlo::train {
namespace {

const Names<ops::Parameterization>& parameterizations() {
  static const Names<ops::Parameterization> names{
      {"velocity", ops::Parameterization::kVelocity},
      {"direct", ops::Parameterization::kDirect},
      {"preconditioned", ops::Parameterization::kPreconditioned}};
  return names;
}
const Names<weights::NormalizationKind>& normalizations() {
  static const Names<weights::NormalizationKind> names{
      {"global", weights::NormalizationKind::kGlobal},
      {"frame", weights::NormalizationKind::kFrame}};
  return names;
}
const Names<weights::PriorKind>& prior_kinds() {
  static const Names<weights::PriorKind> names{{"thesis", weights::PriorKind::kThesis},
                                               {"refined", weights::PriorKind::kRefined}};
  return names;
}
const Names<TruthDirection>& truth_directions() {
  static const Names<TruthDirection> names{{"canonical", TruthDirection::kCanonical},
                                           {"prior", TruthDirection::kPrior}};
  return names;
}
const Names<ObjectiveKind>& objectives() {
  static const Names<ObjectiveKind> names{{"thesis", ObjectiveKind::kThesis},
                                          {"robust", ObjectiveKind::kRobust}};
  return names;
}

/// Visits every field of a recipe by name; reading and writing are two visitors of the same list.
template <class Visitor>
void visit(Visitor& visitor, Recipe& recipe) {
  constexpr double kMany = 1e9;
  visitor.text("name", recipe.name);
  visitor.whole("seed", recipe.seed, 0, kMany);
  visitor.group("variant", [&](Visitor& v) {
    auto& variant = recipe.variant;
    v.choice("parameterization", variant.parameterization, parameterizations());
    v.whole("local_channels", variant.local_channels, 6, 8);
    v.flag("visible_points", variant.visible_points);
    v.whole("head_channels", variant.head_channels, 3, 4);
    v.choice("normalization", variant.normalization, normalizations());
    v.choice("prior_kind", variant.prior_kind, prior_kinds());
    v.real("prior_sd", variant.prior_sd, 1e-4, 10);
  });
  visitor.group("data", [&](Visitor& v) {
    auto& data = recipe.data;
    v.text("maker", data.source.maker);
    v.whole("seed", data.source.seed, 0, kMany);
    v.whole("frames_per_scene", data.source.frames_per_scene, 1, 1000);
    v.real("depth_dropout", data.source.depth_dropout, 0, 1);
    v.whole("training_scenes", data.training_scenes, 1, kMany);
    v.whole("validation_scenes", data.validation_scenes, 1, kMany);
  });
  visitor.group("sampling", [&](Visitor& v) {
    auto& sampling = recipe.sampling;
    v.real("intersection_weight", sampling.intersection_weight, 1e-3, 1e3);
    v.real("hard_weight", sampling.hard_weight, 1e-3, 1e3);
    v.real("wrong_weight", sampling.wrong_weight, 1e-3, 1e3);
    v.real("alternative_share", sampling.alternative_share, 0, 1);
    v.real("rotation_share", sampling.rotation_share, 0, 1);
    v.real("mirror_share", sampling.mirror_share, 0, 1);
    v.real("time_power", sampling.time_power, 0.1, 10);
    v.real("prior_path_share", sampling.prior_path_share, 0, 1);
    v.choice("truth_direction", sampling.truth_direction, truth_directions());
  });
  visitor.group("objective", [&](Visitor& v) {
    auto& objective = recipe.objective;
    v.choice("kind", objective.kind, objectives());
    v.real("spacing", objective.spacing, 0, 1e3);
    v.real("bending", objective.bending, 0, 1e3);
    v.real("huber_delta", objective.huber_delta, 1e-6, 1e3);
    v.real("harm", objective.harm, 0, 1e3);
    v.real("balance", objective.balance, 0, 1);
    v.real("sigma", objective.sigma, 0, 1e3);
  });
  visitor.group("optimizer", [&](Visitor& v) {
    auto& optimizer = recipe.optimizer;
    v.whole("batch", optimizer.batch, 1, 65536);
    v.whole("steps", optimizer.steps, 1, kMany);
    v.real("rate", optimizer.rate, 0, 1);
    v.real("final_rate", optimizer.final_rate, 0, 1);
    v.real("head_rate", optimizer.head_rate, 0, 1e3);
    v.whole("warmup_steps", optimizer.warmup_steps, 0, kMany);
    v.real("beta1", optimizer.beta1, 0, 0.9999999);
    v.real("beta2", optimizer.beta2, 0, 0.9999999);
    v.real("epsilon", optimizer.epsilon, 0, 1);
    v.real("weight_decay", optimizer.weight_decay, 0, 1e3);
    v.real("clip_norm", optimizer.clip_norm, 0, 1e9);
    v.real("ema_decay", optimizer.ema_decay, 0, 0.9999999);
    v.choice("precision", optimizer.precision, precisions());
  });
  visitor.group("schedule", [&](Visitor& v) {
    v.whole("validate_every", recipe.schedule.validate_every, 1, kMany);
    v.whole("checkpoint_every", recipe.schedule.checkpoint_every, 1, kMany);
    v.whole("euler_steps", recipe.schedule.euler_steps, 1, 64);
  });
}

void check_together(const Recipe& recipe, std::vector<std::string>& faults) {
  if (recipe.variant.local_channels == 7) {
    faults.emplace_back("variant.local_channels: expected 6 or 8, got 7");
  }
  if (recipe.objective.sigma > 0 && recipe.variant.head_channels != 4) {
    faults.emplace_back("objective.sigma: expected 0 without variant.head_channels 4");
  }
  if (recipe.name.empty()) faults.emplace_back("name: expected text, got none");
}

}  // namespace

Result<Recipe> parse_recipe(const std::string& json, const std::string& where) {
  return parse_fields<Recipe>(
      json, where, [](ReadVisitor& visitor, Recipe& recipe) { visit(visitor, recipe); },
      check_together);
}

Result<Recipe> read_recipe(const std::filesystem::path& file) {
  const auto text = recipe_text(file);
  if (!text) return text.error();
  return parse_recipe(*text, file.string());
}

std::string to_json(const Recipe& recipe) {
  Recipe copy = recipe;
  WriteVisitor visitor;
  visit(visitor, copy);
  return visitor.dump() + "\n";
}

}  // namespace flowdlo::train
