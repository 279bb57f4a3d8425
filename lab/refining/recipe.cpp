#include "refining/recipe.hpp"

#include <vector>

#include "train/json_visitor.hpp"

namespace flowdlo::refining {
namespace {

void visit(train::ReadVisitor& visitor, Recipe& recipe) {
  constexpr double kMany = 1e9;
  visitor.text("name", recipe.name);
  visitor.whole("seed", recipe.seed, 0, kMany);
  visitor.group("data", [&](train::ReadVisitor& v) {
    v.whole("first", recipe.data.first, 0, kMany);
    v.whole("scenes", recipe.data.scenes, 1, kMany);
    v.real("matched", recipe.data.matched, 0, 1);
    v.real("seen", recipe.data.seen, 0, 1);
    v.real("uneven", recipe.data.uneven, 0, 1);
  });
  visitor.group("schedule", [&](train::ReadVisitor& v) {
    Schedule& schedule = recipe.schedule;
    v.whole("batch", schedule.batch, 1, 4096);
    v.whole("steps", schedule.steps, 1, kMany);
    v.real("rate", schedule.rate, 0, 1);
    v.real("final_rate", schedule.final_rate, 0, 1);
    v.whole("warmup_steps", schedule.warmup_steps, 0, kMany);
    v.real("weight_decay", schedule.weight_decay, 0, 1e3);
    v.real("clip_norm", schedule.clip_norm, 0, 1e9);
    v.real("ema_decay", schedule.ema_decay, 0, 0.9999999);
    v.real("matched_weight", schedule.matched_weight, 0, 1e3);
    v.real("harm", schedule.harm, 0, 100);
    v.real("most_index_mm", schedule.most_index_mm, 0.1, 1e6);
    v.real("most_deep_mm", schedule.most_deep_mm, 0.1, 1e6);
  });
}

}  // namespace

Result<Recipe> parse_recipe(const std::string& json, const std::string& where) {
  return train::parse_fields<Recipe>(json, where, visit,
                                     [](const Recipe& recipe, std::vector<std::string>& faults) {
                                       if (recipe.name.empty()) {
                                         faults.emplace_back("name: expected text, got none");
                                       }
                                     });
}

Result<Recipe> read_recipe(const std::filesystem::path& file) {
  const auto text = train::recipe_text(file);
  if (!text) return text.error();
  return parse_recipe(*text, file.string());
}

}  // namespace flowdlo::refining
