// flowdlo-train records: fills a folder with training and validation records.
#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "progress_bar.hpp"
#include "threads/count.hpp"
#include "train/commands.hpp"
#include "train/recipe.hpp"
#include "train/record_folder.hpp"

namespace flowdlo::train {
namespace {

struct Arguments {
  std::filesystem::path recipe;
  std::filesystem::path folder;
  std::uint64_t training = 0;
  std::uint64_t validation = 0;
  int threads = 0;
  bool quiet = false;
};

Result<void> make_part(const Arguments& arguments, const Recipe& recipe, Part part,
                       std::uint64_t scenes) {
  const int threads = threads::count(arguments.threads);
  support::ProgressBar bar(fmt::format("{} records", name_of(part)), static_cast<int>(scenes),
                           arguments.quiet);
  auto made = make_records(arguments.folder, part, scenes, recipe.data.source,
                           recipe.record_options(), threads, [&] { bar.advance(); });
  if (!made) return made;
  const auto set = load_records(arguments.folder, part);
  if (!set) return set.error();
  bar.clear();
  fmt::print("{}: {} records of {} scenes, {} without a path, SHA-256 {}\n", name_of(part),
             set->records.size(), set->scenes, set->skipped, set->sha256);
  return {};
}

int run(const Arguments& arguments) {
  const auto recipe = read_recipe(arguments.recipe);
  if (!recipe) {
    fmt::print(stderr, "{}\n", recipe.error().message);
    return 2;
  }
  const auto chosen = [](std::uint64_t asked, std::uint64_t recipes) {
    return asked > 0 ? asked : recipes;
  };
  auto made = make_part(arguments, *recipe, Part::kValidation,
                        chosen(arguments.validation, recipe->data.validation_scenes));
  if (made) {
    made = make_part(arguments, *recipe, Part::kTraining,
                     chosen(arguments.training, recipe->data.training_scenes));
  }
  if (made) return 0;
  fmt::print(stderr, "{}\n", made.error().message);
  return 1;
}

}  // namespace

void add_records_command(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<Arguments>();
  auto* command = app.add_subcommand(
      "records",
      "Run the engine on synthetic scenes and keep what training needs. Goes on where "
      "an earlier call stopped; a training run takes up what is added meanwhile.");
  command->add_option("recipe", arguments->recipe, "Recipe, JSON")->required();
  command->add_option("--out", arguments->folder, "Folder for the shards")->required();
  command->add_option("--training", arguments->training, "Scenes instead of the recipe's number");
  command->add_option("--validation", arguments->validation, "The same for validation");
  command->add_option("--threads", arguments->threads, "0: one a core")->check(CLI::Range(0, 1024));
  command->add_flag("--quiet", arguments->quiet, "No progress bar");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace flowdlo::train
