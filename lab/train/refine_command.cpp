// flowdlo-train refine: data, training and export of the refining network.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>

#include "files/whole_file.hpp"
#include "progress_bar.hpp"
#include "refining/recipe.hpp"
#include "refining/strip_store.hpp"
#include "refining/trainer.hpp"
#include "threads/count.hpp"
#include "train/commands.hpp"
#include "train/device.hpp"
#include "weights/field_weights.hpp"

namespace flowdlo::train {
namespace {

struct Arguments {
  std::filesystem::path recipe;
  std::filesystem::path field;
  std::filesystem::path folder;
  std::string device = "auto";
  int threads = 0;
  bool records_only = false;
  bool quiet = false;
  std::string command;
};

int refine(const Arguments& arguments) {
  const auto device = choose_device(arguments.device);
  if (!device) return failed(device.error());
  const auto recipe = refining::read_recipe(arguments.recipe);
  if (!recipe) return failed(recipe.error(), 2);
  auto loaded = weights::load_field(arguments.field);
  if (!loaded) return failed(loaded.error(), 2);
  const auto field = std::make_shared<weights::FieldWeights>(*std::move(loaded));
  const auto strips = arguments.folder / "strips";
  support::ProgressBar bar("scenes", static_cast<int>(recipe->data.scenes), arguments.quiet);
  const auto made = refining::make_strips(
      strips, recipe->data, field, threads::count(arguments.threads), [&] { bar.advance(); });
  bar.clear();
  if (!made) return failed(made.error());
  if (arguments.records_only) return 0;
  const auto samples = refining::read_strips(strips);
  if (!samples) return failed(samples.error());
  use_threads(arguments.threads);
  const auto trained = refining::train(*recipe, *samples, *device, [&](const std::string& line) {
    if (!arguments.quiet) fmt::print("{}\n", line);
    std::fflush(stdout);
  });
  if (!trained) return failed(trained.error());
  field->refine = refining::exported(
      trained->network,
      fmt::format("{}; {} strips; {}", arguments.command, samples->size(), describe(*device)));
  const auto file = arguments.folder / "field.safetensors";
  if (auto saved = weights::save_field(*field, file); !saved) return failed(saved.error());
  fmt::print("{}{}: the field of {} with this network\n", trained->table, file.string(),
             arguments.field.string());
  return 0;
}

}  // namespace

void add_refine_command(CLI::App& app, int argc, char** argv, int& exit_code) {
  auto arguments = std::make_shared<Arguments>();
  arguments->command = "flowdlo-train";
  for (int i = 1; i < argc; ++i) arguments->command += std::string(" ") + argv[i];
  auto* command = app.add_subcommand(
      "refine",
      "Train the network that refines nodes: render and read scenes (going on where an earlier "
      "call stopped), train, and write OUT/field.safetensors, the strand field with it");
  command->add_option("recipe", arguments->recipe, "Recipe of a refining network, JSON")
      ->required();
  command->add_option("--field", arguments->field, "Weights of a strand field, .safetensors")
      ->required();
  command->add_option("--out", arguments->folder, "Folder of strips and result")->required();
  command->add_option("--device", arguments->device, "What trains; strips are made by the CPU")
      ->check(CLI::IsMember({"auto", "cpu", "cuda"}));
  command->add_option("--threads", arguments->threads, "0: one a core")->check(CLI::Range(0, 1024));
  command->add_flag("--records-only", arguments->records_only, "Make the strips and end");
  command->add_flag("--quiet", arguments->quiet, "No lines of progress");
  command->callback([arguments, &exit_code] { exit_code = refine(*arguments); });
}

}  // namespace flowdlo::train
