// flowdlo-train export and curves: what a run leaves behind.
#include <fmt/format.h>

#include <ctime>
#include <filesystem>
#include <memory>
#include <string>

#include "train/commands.hpp"
#include "train/curves.hpp"
#include "train/export.hpp"

namespace flowdlo::train {
namespace {

struct Arguments {
  std::filesystem::path folder;
  std::filesystem::path output;
  std::string precision = "f16";
};

std::string today() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  ::gmtime_r(&now, &parts);
  return fmt::format("{:04}-{:02}-{:02}", parts.tm_year + 1900, parts.tm_mon + 1, parts.tm_mday);
}

int run_export(const Arguments& arguments) {
  const auto state = load_checkpoint(arguments.folder / "checkpoint.pt", torch::kCPU);
  if (!state) return failed(state.error());
  const auto type =
      arguments.precision == "f16" ? weights::StorageType::kF16 : weights::StorageType::kF32;
  const auto done = export_weights(to_weights(*state, today()), arguments.output, type);
  if (!done) return failed(done.error());
  fmt::print("{}: {} after {} steps\n", arguments.output.string(), state->recipe.name, state->step);
  return 0;
}

}  // namespace

void add_export_command(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<Arguments>();
  auto* command = app.add_subcommand("export", "A run's weights as .fdw or .safetensors");
  command->add_option("run", arguments->folder, "Folder of the run")->required();
  command->add_option("output", arguments->output, "Ends in .fdw or .safetensors")->required();
  command->add_option("--precision", arguments->precision, "f16 or f32")
      ->check(CLI::IsMember({"f16", "f32"}));
  command->callback([arguments, &exit_code] { exit_code = run_export(*arguments); });
}

void add_curves_command(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<Arguments>();
  auto* command = app.add_subcommand("curves", "Draw curves.png from a run's log");
  command->add_option("run", arguments->folder, "Folder of the run")->required();
  command->callback([arguments, &exit_code] {
    const auto done = plot_curves(arguments->folder);
    exit_code = done ? 0 : failed(done.error());
  });
}

}  // namespace flowdlo::train
