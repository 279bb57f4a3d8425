// Completion and manual: what a shell and man(1) are told of a program.
#pragma once

#include <CLI/App.hpp>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "command_table.hpp"
#include "exit_code.hpp"

namespace flowdlo::support {

/// The commands of a program, those of another that it runs included.
using TableOf = std::function<std::vector<CommandRow>(const CLI::App&)>;

/// Adds both to `app`, of what `table_of` says of it. When one runs, it sets `exit_code`.
void add_shell_commands(CLI::App& app, ExitCode& exit_code,
                        const TableOf& table_of = command_table);

/// The name of a command that no help shows: it prints the program's commands as json_of() has
/// them.
inline constexpr const char* kTableCommand = "command-table";
void add_table_command(CLI::App& app);

/// What to say of the first of a command line's `words` that stands where `app`, or one of its
/// commands, has commands and is none of them, with the nearest one; empty where there is no such
/// word before the first option.
[[nodiscard]] std::string unknown_command(const CLI::App& app, std::span<char* const> words);

}  // namespace flowdlo::support
