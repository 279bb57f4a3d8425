#include "weights_command.hpp"

#include <fmt/format.h>

#include <CLI/App.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "command_line.hpp"
#include "files/shown_name.hpp"
#include "flowdlo/weights.hpp"
#include "terminal.hpp"

namespace flowdlo::tools {
namespace {

struct Files {
  std::filesystem::path input;
  std::filesystem::path output;
  int fast_steps = 0;
  int fast_draws = 0;
};

support::ExitCode report(const Error& error) {
  support::tell_error("{}\n", error.message);
  return support::ExitCode::kFailed;
}

support::ExitCode print_info(const std::filesystem::path& file) {
  const auto info = inspect_weights(file);
  if (!info) return report(info.error());
  for (const auto& [field, value] : info->metadata) support::tell("{:<24} {}\n", field, value);
  support::tell("{:<24} {}\n{:<24} {}\n\n", "parameters", info->parameters, "sha256", info->sha256);
  for (const auto& tensor : info->tensors) {
    support::tell("{:<32} {:<4} [{}]\n", files::shown(tensor.name), tensor.dtype,
                  fmt::join(tensor.shape, ", "));
  }
  return support::ExitCode::kDone;
}

support::ExitCode outcome(const Result<void>& done, const Files& paths) {
  if (!done) return report(done.error());
  support::tell("{} -> {}\n", files::shown(paths.input), files::shown(paths.output));
  return support::ExitCode::kDone;
}

}  // namespace

void add_weights_command(CLI::App& app, support::ExitCode& exit_code) {
  auto files = std::make_shared<Files>();
  auto* command = support::add_command(app, "weights", "Look into weights files and convert them");
  command->require_subcommand(1);

  auto* info =
      support::add_command(*command, "info", "Metadata, tensor names, shapes and checksum");
  info->add_option("FILE", files->input, "A .fdw file")->required();
  info->callback([files, &exit_code] { exit_code = print_info(files->input); });

  auto* to = support::add_command(*command, "export", "From .fdw to .safetensors");
  to->add_option("FILE", files->input, "A .fdw file")->required();
  to->add_option("OUT", files->output, "The .safetensors file to write")->required();
  to->callback([files, &exit_code] {
    exit_code = outcome(export_safetensors(files->input, files->output), *files);
  });

  auto* from = support::add_command(*command, "import", "From .safetensors to .fdw");
  from->add_option("IN", files->input, "A .safetensors file")->required();
  from->add_option("OUT", files->output, "The .fdw file to write")->required();
  from->callback([files, &exit_code] {
    exit_code = outcome(import_safetensors(files->input, files->output), *files);
  });

  auto* fast = support::add_command(*command, "set-fast", "Say what --quality fast stands for");
  fast->add_option("FILE", files->input, "A .fdw file")->required();
  fast->add_option("OUT", files->output, "The .fdw file to write; may be FILE")->required();
  fast->add_option("--steps", files->fast_steps, "Euler steps; 0: as full")
      ->required()
      ->check(CLI::Range(0, 64));
  fast->add_option("--draws", files->fast_draws, "Gaussian sources; 0: as full")
      ->required()
      ->check(CLI::Range(0, 64));
  fast->callback([files, &exit_code] {
    exit_code =
        outcome(set_fast_quality(files->input, files->fast_steps, files->fast_draws, files->output),
                *files);
  });
}

}  // namespace flowdlo::tools
