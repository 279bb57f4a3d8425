#include "command_line.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <span>
#include <sstream>
#include <utility>

#include "shell_commands.hpp"
#include "terminal.hpp"

namespace flowdlo::support {
namespace {

/// What CLI11 has to say: help, the version, or what is wrong with the arguments.
ExitCode explained(const CLI::App& app, const CLI::ParseError& end) {
  std::ostringstream out;
  std::ostringstream err;
  const int code = app.exit(end, out, err);
  say(stdout, out.str());
  say(stderr, err.str());
  return code == 0 ? ExitCode::kDone : ExitCode::kUsage;
}

ExitCode run(CLI::App& app, int argc, char** argv, const ExitCode& exit_code) {
  const auto words = std::span(argv, static_cast<std::size_t>(argc)).subspan(argc > 0 ? 1 : 0);
  if (const auto unknown = unknown_command(app, words); !unknown.empty()) {
    tell_error("{}", unknown);
    return ExitCode::kUsage;
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& end) {  // --help and --version come this way as well
    return explained(app, end);
  } catch (const std::exception& failure) {
    tell_error("{}: {}\n", app.get_name(), failure.what());
    return ExitCode::kFailed;
  }
  return exit_code;
}

}  // namespace

CLI::App* add_command(CLI::App& parent, const std::string& name, const std::string& description) {
  return parent.add_subcommand(name, description);
}

void set_action(CLI::App& command, ExitCode& exit_code, std::function<int()> action) {
  command.callback(
      [&exit_code, action = std::move(action)] { exit_code = static_cast<ExitCode>(action()); });
}

int run_command_line(CLI::App& app, int argc, char** argv, const ExitCode& exit_code) {
  return finished(app.get_name(), static_cast<int>(run(app, argc, argv, exit_code)));
}

}  // namespace flowdlo::support
