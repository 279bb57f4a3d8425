#include "shell_commands.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <numeric>
#include <span>
#include <string>
#include <system_error>
#include <vector>

#include "choice.hpp"
#include "command_line.hpp"
#include "command_table.hpp"
#include "completion.hpp"
#include "durability_choice.hpp"
#include "files/shown_name.hpp"
#include "files/staged_files.hpp"
#include "flowdlo/version.hpp"
#include "manual.hpp"
#include "terminal.hpp"

namespace flowdlo::support {
namespace {

constexpr std::size_t kMistyped = 2;  ///< letters that differ where a word was meant all the same

Result<void> write_manual(const std::filesystem::path& folder, const CLI::App& app,
                          const std::vector<CommandRow>& table) {
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  files::StagedFiles staged(chosen_durability());
  for (const auto& [file, text] : manual(app.get_name(), FLOWDLO_VERSION, table)) {
    if (auto done = staged.add(folder / file, text); !done) return done;
  }
  return staged.commit();
}

/// Letters to be put in, left out or replaced to make one word of the other.
std::size_t apart(const std::string& one, const std::string& other) {
  std::vector<std::size_t> row(other.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= one.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= other.size(); ++j) {
      const std::size_t replaced = diagonal + (one[i - 1] == other[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

/// That `word` is none of the commands `known` to the program or command `name`.
std::string not_among(const std::vector<std::string>& known, const std::string& name,
                      const std::string& word) {
  const auto off = [&](const std::string& command) {
    return command.starts_with(word) ? 0 : apart(word, command);
  };
  const auto nearest =
      std::min_element(known.begin(), known.end(),
                       [&](const auto& one, const auto& other) { return off(one) < off(other); });
  const bool meant = off(*nearest) <= kMistyped;
  return fmt::format("{}: expected a command ({}), got \"{}\"; {}\n", name, fmt::join(known, ", "),
                     files::shown(word),
                     meant ? fmt::format("did you mean {}?", *nearest)
                           : fmt::format("{} --help says what each does", name));
}

}  // namespace

void add_shell_commands(CLI::App& app, ExitCode& exit_code, const TableOf& table_of) {
  auto shell = std::make_shared<Shell>(Shell::kBash);
  auto* words = add_command(app, "completion", "Print a shell's completion script");
  words
      ->add_option("SHELL", *shell,
                   "Which one: source what it prints, or put it where the shell looks")
      ->required()
      ->transform(
          choice<Shell>({{"bash", Shell::kBash}, {"zsh", Shell::kZsh}, {"fish", Shell::kFish}}))
      ->type_name("");
  words->callback(
      [shell, &app, table_of] { tell("{}", completion(*shell, app.get_name(), table_of(app))); });

  auto folder = std::make_shared<std::filesystem::path>();
  auto* pages = add_command(app, "manual", "Write the manual pages");
  pages->add_option("DIR", *folder, "Where they go: man -l DIR/flowdlo.1 shows one")->required();
  pages->callback([folder, &app, &exit_code, table_of] {
    const auto written = write_manual(*folder, app, table_of(app));
    if (written) return;
    tell_error("{}\n", written.error().message);
    exit_code = ExitCode::kFailed;
  });
}

void add_table_command(CLI::App& app) {
  add_command(app, kTableCommand, "The commands and their options as JSON")
      ->group("")
      ->callback([&app] { tell("{}\n", json_of(command_table(app))); });
}

std::string unknown_command(const CLI::App& app, std::span<char* const> words) {
  const CLI::App* command = &app;
  std::string name = app.get_name();
  for (const std::string word : words) {
    const bool needed = command->get_require_subcommand_min() > 0;  // "eval" takes a set as well
    if (!needed || word.empty() || word.front() == '-' || word == kTableCommand) return {};
    const auto known = command_table(*command).front().commands;
    if (std::find(known.begin(), known.end(), word) == known.end()) {
      return not_among(known, name, word);
    }
    command = command->get_subcommand(word);
    name += ' ' + word;
  }
  return {};
}

}  // namespace flowdlo::support
