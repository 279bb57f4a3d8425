#include "lab_program.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <system_error>

#include "command_line.hpp"
#include "exit_code.hpp"
#include "files/own_file.hpp"
#include "files/shown_name.hpp"
#include "shell_commands.hpp"
#include "terminal.hpp"

namespace flowdlo::tools {
namespace {

namespace fs = std::filesystem;

struct LabCommand {
  const char* name;
  const char* description;
};
constexpr std::array<LabCommand, 2> kCommands{
    {{"synth", "Synthetic frames with truth"},
     {"eval", "Frames with truth in, tables and plots out"}}};

bool is_lab_command(const std::string& word) {
  return std::any_of(kCommands.begin(), kCommands.end(),
                     [&](const LabCommand& command) { return word == command.name; });
}

/// Beside the executable, built or installed.
fs::path lab_program() { return files::running_program().parent_path() / "flowdlo-lab"; }

/// Everything that can be read from `end`, which is closed.
std::string drained(int end) {
  std::string text;
  std::array<char, 4096> buffer{};
  for (;;) {
    const ssize_t count = ::read(end, buffer.data(), buffer.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    text.append(buffer.data(), static_cast<std::size_t>(count));
  }
  ::close(end);
  return text;
}

/// What flowdlo-lab prints of its commands; empty where it cannot be run.
std::string said_by_lab() {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return {};
  std::string program = lab_program().string();
  std::string command = support::kTableCommand;
  const std::array<char*, 3> arguments{program.data(), command.data(), nullptr};
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  pid_t child = 0;
  const int failed =
      ::posix_spawn(&child, program.c_str(), &actions, nullptr, arguments.data(), environ);
  ::posix_spawn_file_actions_destroy(&actions);
  ::close(ends[1]);
  auto said = drained(ends[0]);
  int status = 0;
  if (failed != 0) return {};
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? said : std::string();
}

}  // namespace

void add_lab_commands(CLI::App& app) {
  for (const auto& [name, description] : kCommands) support::add_command(app, name, description);
}

bool is_for_lab(int argc, char** argv) { return argc > 1 && is_lab_command(argv[1]); }

int become_lab(char** argv) {
  const auto program = lab_program();
  ::execv(program.c_str(), argv);
  const int code = errno;
  support::tell_error(
      "flowdlo {}: expected the program flowdlo-lab at {}, which cannot be run: {}; build the "
      "target flowdlo_lab_cli, for which \"scripts/install eval\" installs what it needs, or "
      "install "
      "flowdlo-lab beside flowdlo\n",
      argv[1], files::shown(program), std::generic_category().message(code));
  return static_cast<int>(support::ExitCode::kFailed);
}

std::vector<support::CommandRow> table_with_lab(const CLI::App& app) {
  auto table = support::command_table(app);
  const auto lab = support::table_of_json(said_by_lab());
  const auto is_lab_row = [](const support::CommandRow& row) {
    return !row.path.empty() && is_lab_command(row.path.front());
  };
  for (const auto& command : kCommands) {
    const auto at = std::find_if(table.begin(), table.end(), [&](const support::CommandRow& row) {
      return row.path == std::vector<std::string>{command.name};
    });
    if (at == table.end() || std::none_of(lab.begin(), lab.end(), is_lab_row)) continue;
    auto place = table.erase(at);
    for (const auto& row : lab) {
      if (row.path.empty() || row.path.front() != command.name) continue;
      place = table.insert(place, row) + 1;
    }
  }
  return table;
}

}  // namespace flowdlo::tools
