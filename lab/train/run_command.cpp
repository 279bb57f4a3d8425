// flowdlo-train train and resume: a run from its recipe, or from its checkpoint.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "progress_bar.hpp"
#include "train/blas.hpp"
#include "train/commands.hpp"
#include "train/device.hpp"
#include "train/trainer.hpp"

namespace flowdlo::train {
namespace {

struct Arguments {
  std::filesystem::path recipe;
  std::filesystem::path folder;
  std::filesystem::path records;
  std::string device = "auto";
  std::string precision;
  int threads = 0;
  int loader_threads = 1;
  int batch = 0;
  int steps = 0;
  std::int64_t stop_after = 0;
  bool fixed_records = false;
  bool quiet = false;
  std::string command;
};

void say_blas() {
  const Blas blas = find_blas();
  fmt::print("BLAS: {}\n", blas.name);
  if (blas.slow) {
    fmt::print(stderr,
               "warning: {} is the reference BLAS; training is up to 35 times slower than with "
               "OpenBLAS: apt-get install libopenblas0-pthread, or choose it with "
               "update-alternatives --config libblas.so.3-x86_64-linux-gnu\n",
               blas.name);
  }
}

int run(TrainingState& state, const Arguments& arguments, torch::Device device) {
  support::ProgressBar bar("steps", static_cast<int>(state.recipe.optimizer.steps - state.step),
                           arguments.quiet);
  const auto note = [&](const std::string& line) {
    bar.clear();
    fmt::print("{}\n", line);
    std::fflush(stdout);
  };
  RunOptions options;
  options.folder = arguments.folder;
  options.records = arguments.records;
  options.loader_threads = arguments.loader_threads;
  options.grow = !arguments.fixed_records;
  options.stop_after = arguments.stop_after;
  options.on_step = [&](const StepReport&) { bar.advance(); };
  options.on_note = note;
  const auto trained = train(state, options, device);
  if (!trained) return failed(trained.error());
  note(fmt::format("{} steps done; checkpoint and log in {}", state.step,
                   arguments.folder.string()));
  return 0;
}

/// Device and threads; nothing where the arguments are wrong.
std::optional<torch::Device> prepare(const Arguments& arguments, std::string& words) {
  const auto device = choose_device(arguments.device);
  if (!device) {
    fmt::print(stderr, "{}\n", device.error().message);
    return std::nullopt;
  }
  use_threads(arguments.threads);
  words = describe(*device);
  fmt::print("device: {}\n", words);
  if (device->is_cpu()) say_blas();
  return *device;
}

int start_run(const Arguments& arguments) {
  auto recipe = read_recipe(arguments.recipe);
  if (!recipe) return failed(recipe.error(), 2);
  if (arguments.batch > 0) recipe->optimizer.batch = arguments.batch;
  if (arguments.steps > 0) recipe->optimizer.steps = arguments.steps;
  if (!arguments.precision.empty()) {
    recipe->optimizer.precision =
        arguments.precision == "bf16" ? Precision::kBf16 : Precision::kF32;
  }
  if (std::filesystem::exists(arguments.folder / "checkpoint.pt")) {
    return failed({ErrorCode::kBadInput,
                   fmt::format("{}: expected no checkpoint there yet; use flowdlo-train resume, or "
                               "another folder",
                               arguments.folder.string())},
                  2);
  }
  std::string words;
  const auto device = prepare(arguments, words);
  if (!device) return 2;
  TrainingState state = start(*recipe, *device);
  state.command = arguments.command;
  state.device = words;
  return run(state, arguments, *device);
}

int resume_run(const Arguments& arguments) {
  std::string words;
  const auto device = prepare(arguments, words);
  if (!device) return 2;
  auto state = load_checkpoint(arguments.folder / "checkpoint.pt", *device);
  if (!state) return failed(state.error());
  if (!arguments.recipe.empty()) {
    auto recipe = read_recipe(arguments.recipe);
    if (!recipe) return failed(recipe.error(), 2);
    if (auto taken = take_recipe(*state, *recipe); !taken) return failed(taken.error(), 2);
    state->command += fmt::format(", from step {}: {}", state->step, arguments.command);
  }
  if (arguments.steps > 0) state->recipe.optimizer.steps = arguments.steps;
  if (state->device != words) state->device += ", then " + words;
  return run(*state, arguments, *device);
}

void add_common(CLI::App& command, Arguments& arguments) {
  command.add_option("--out", arguments.folder, "Folder of checkpoint, log and curves")->required();
  command.add_option("--records", arguments.records, "Folder that flowdlo-train records filled")
      ->required();
  command.add_option("--device", arguments.device, "auto, cpu or cuda")
      ->check(CLI::IsMember({"auto", "cpu", "cuda"}));
  command.add_option("--threads", arguments.threads, "Of the CPU; 0: one a core")
      ->check(CLI::Range(0, 1024));
  command.add_option("--loader-threads", arguments.loader_threads, "Threads that make batches")
      ->check(CLI::Range(1, 1024));
  command.add_option("--steps", arguments.steps, "Optimiser steps instead of the recipe's number");
  command.add_option("--stop-after", arguments.stop_after, "End this call after so many steps");
  command.add_flag("--fixed-records", arguments.fixed_records,
                   "Take up no records that appear meanwhile");
  command.add_flag("--quiet", arguments.quiet, "No progress bar");
}

std::string joined(int argc, char** argv) {
  std::string text = "flowdlo-train";
  for (int i = 1; i < argc; ++i) text += std::string(" ") + argv[i];
  return text;
}

}  // namespace

void add_train_command(CLI::App& app, int argc, char** argv, int& exit_code) {
  auto arguments = std::make_shared<Arguments>();
  arguments->command = joined(argc, argv);
  auto* command = app.add_subcommand("train", "Train a model from its recipe");
  command->add_option("recipe", arguments->recipe, "Recipe, JSON")->required();
  add_common(*command, *arguments);
  command->add_option("--batch", arguments->batch, "Records a step instead of the recipe's number");
  command->add_option("--precision", arguments->precision, "Instead of the recipe's")
      ->check(CLI::IsMember({"bf16", "f32"}));
  command->callback([arguments, &exit_code] { exit_code = start_run(*arguments); });
}

void add_resume_command(CLI::App& app, int argc, char** argv, int& exit_code) {
  auto arguments = std::make_shared<Arguments>();
  arguments->command = joined(argc, argv);
  auto* command = app.add_subcommand("resume", "Go on from the checkpoint in --out, exactly");
  command->add_option("--recipe", arguments->recipe,
                      "Go on with this one: another sampling, objective or schedule of the same "
                      "model");
  add_common(*command, *arguments);
  command->callback([arguments, &exit_code] { exit_code = resume_run(*arguments); });
}

}  // namespace flowdlo::train
