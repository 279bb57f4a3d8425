// CommandTable: the commands and options of a program as CLI11 knows them, as plain values, for
// what is made of them: manual pages and shells' completion.
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

namespace flowdlo::support {

struct OptionRow {
  std::vector<std::string> names;    ///< "-h", "--help"; of a positional one its name, "FRAME"
  std::string value;                 ///< what follows it, "N" or "full|fast"; empty: a flag
  std::vector<std::string> choices;  ///< the words that it takes, where these are all
  std::string limits;                ///< "INT in [1 - 64]"; empty: none
  std::string default_value;         ///< empty: none, or said by the description
  std::string description;
  std::string group;  ///< the heading it stands under, "Options" unless it has one of its own
  bool positional = false;
  bool required = false;
};

struct CommandRow {
  std::vector<std::string> path;  ///< {"weights", "info"}; empty: the program itself
  std::vector<std::string> aliases;
  std::string description;
  std::vector<OptionRow> options;
  std::vector<std::string> commands;  ///< names of the commands below, aliases included
};

/// The program first, then every command below it, each before those below it.
[[nodiscard]] std::vector<CommandRow> command_table(const CLI::App& app);

/// A table as JSON, for another program.
[[nodiscard]] std::string json_of(const std::vector<CommandRow>& table);
/// What json_of() made; empty where `text` is anything else.
[[nodiscard]] std::vector<CommandRow> table_of_json(const std::string& text);

}  // namespace flowdlo::support
