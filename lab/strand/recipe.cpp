#include "strand/recipe.hpp"

#include "train/json_visitor.hpp"

namespace flowdlo::strand {
namespace {

/// Visits every field of a recipe by name; reading and writing are two visitors of the same list.
template <class Visitor>
void visit(Visitor& visitor, Recipe& recipe) {
  constexpr double kMany = 1e9;
  visitor.text("name", recipe.name);
  visitor.whole("seed", recipe.seed, 0, kMany);
  visitor.group("network", [&](Visitor& v) {
    v.whole("fine", recipe.network.fine, 16, 256);
    v.whole("middle", recipe.network.middle, 16, 256);
    v.whole("coarse", recipe.network.coarse, 16, 256);
  });
  visitor.group("data", [&](Visitor& v) {
    v.whole("seed", recipe.data.seed, 0, kMany);
    v.whole("scenes", recipe.data.scenes, 1, kMany);
    v.real("several", recipe.data.several, 0, 1);
    v.real("tangled", recipe.data.tangled, 0, 1);
    v.real("drawn", recipe.data.drawn, 0, 1);
    v.real("touching", recipe.data.touching, 0, 1);
    v.real("matched", recipe.data.matched, 0, 1);
    v.real("cords", recipe.data.cords, 0, 1);
    v.group("patch", [&](Visitor& inside) {
      PatchConfig& patch = recipe.data.patch;
      inside.whole("each", patch.each, 1, 100);
      inside.real("half_widths", patch.half_widths, 2, 100);
      inside.whole("least_half_px", patch.least_half_px, 8, 1000);
      inside.real("most_rope_px", patch.most_rope_px, 4, 100);
      inside.real("near_share", patch.near_share, 0, 1);
      inside.real("end_share", patch.end_share, 0, 1);
      inside.real("hidden_share", patch.hidden_share, 0, 1);
    });
  });
  visitor.group("spoil", [&](Visitor& v) {
    SpoilConfig& spoil = recipe.spoil;
    v.real("width_spread", spoil.width_spread, 0, 1);
    v.real("width_wrong_share", spoil.width_wrong_share, 0, 1);
    v.real("width_wrong", spoil.width_wrong, 1, 4);
    v.real("no_color", spoil.no_color, 0, 1);
    v.real("no_depth", spoil.no_depth, 0, 1);
    v.real("mask_alone", spoil.mask_alone, 0, 1);
    v.real("grey", spoil.grey, 0, 1);
    v.real("flat", spoil.flat, 0, 1);
    v.real("dark", spoil.dark, 0, 1);
    v.real("moved", spoil.moved, 0, 1);
    v.real("level", spoil.level, 0, 1);
    v.real("mask_depth", spoil.mask_depth, 0, 1);
  });
  visitor.group("loss", [&](Visitor& v) {
    LossConfig& loss = recipe.loss;
    v.real("centre", loss.centre, 0, 1e3);
    v.real("direction", loss.direction, 0, 1e3);
    v.real("tip", loss.tip, 0, 1e3);
    v.real("under", loss.under, 0, 1e3);
    v.real("width", loss.width, 0, 1e3);
    v.real("rope", loss.rope, 0, 1e3);
    v.real("edge", loss.edge, 0, 1e3);
  });
  visitor.group("schedule", [&](Visitor& v) {
    Schedule& schedule = recipe.schedule;
    v.whole("batch", schedule.batch, 1, 4096);
    v.whole("size_px", schedule.size_px, 32, 1024);
    v.whole("steps", schedule.steps, 1, kMany);
    v.real("rate", schedule.rate, 0, 1);
    v.real("final_rate", schedule.final_rate, 0, 1);
    v.whole("warmup_steps", schedule.warmup_steps, 0, kMany);
    v.real("weight_decay", schedule.weight_decay, 0, 1e3);
    v.real("clip_norm", schedule.clip_norm, 0, 1e9);
    v.real("ema_decay", schedule.ema_decay, 0, 0.9999999);
    v.whole("checkpoint_every", schedule.checkpoint_every, 1, kMany);
    v.choice("precision", schedule.precision, train::precisions());
  });
}

void check_together(const Recipe& recipe, std::vector<std::string>& faults) {
  if (recipe.name.empty()) faults.emplace_back("name: expected text, got none");
  const NetworkConfig& network = recipe.network;
  if (network.fine % 16 != 0 || network.middle % 16 != 0 || network.coarse % 16 != 0) {
    faults.emplace_back("network: expected channels in multiples of 16");
  }
  if (recipe.schedule.size_px % 8 != 0) {
    faults.push_back(
        fmt::format("schedule.size_px: expected a multiple of 8, got {}", recipe.schedule.size_px));
  }
}

}  // namespace

Result<Recipe> parse_recipe(const std::string& json, const std::string& where) {
  return train::parse_fields<Recipe>(
      json, where, [](train::ReadVisitor& visitor, Recipe& recipe) { visit(visitor, recipe); },
      check_together);
}

Result<Recipe> read_recipe(const std::filesystem::path& file) {
  const auto text = train::recipe_text(file);
  if (!text) return text.error();
  return parse_recipe(*text, file.string());
}

std::string to_json(const Recipe& recipe) {
  Recipe copy = recipe;
  train::WriteVisitor visitor;
  visit(visitor, copy);
  return visitor.dump() + "\n";
}

}  // namespace flowdlo::strand
