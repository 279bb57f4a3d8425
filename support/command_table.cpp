#include "command_table.hpp"

#include <CLI/App.hpp>
#include <algorithm>
#include <cctype>
#include <nlohmann/json.hpp>
#include <string_view>

namespace flowdlo::support {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(OptionRow, names, value, choices, limits, default_value,
                                   description, group, positional, required)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(CommandRow, path, aliases, description, options, commands)

namespace {

/// "full|fast" as its words; none where `text` is anything else.
std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words(1);
  for (const char letter : text) {
    const bool of_word = std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '-';
    if (letter == '|') {
      words.emplace_back();
    } else if (of_word) {
      words.back() += letter;
    } else {
      return {};
    }
  }
  const bool are_words = words.size() > 1 && std::none_of(words.begin(), words.end(),
                                                          [](const auto& w) { return w.empty(); });
  return are_words ? words : std::vector<std::string>{};
}

/// "N:INT in [1 - 64]" is a value and its limits; "KIND:auto|thesis" a value and its choices.
void put_type(const std::string& type, OptionRow& row) {
  const auto colon = type.find(':');
  row.value = type.substr(0, colon);
  if (colon == std::string::npos) return;
  row.limits = type.substr(colon + 1);
  row.choices = words_of(row.limits);
  if (row.choices.empty() && row.limits != row.value) return;
  if (!row.choices.empty()) row.value = row.limits;
  row.limits.clear();
}

OptionRow row_of(const CLI::Option& option) {
  OptionRow row;
  row.positional = option.get_positional();
  if (row.positional) {
    row.names.push_back(option.get_name(/*positional=*/true));
  } else {
    for (const auto& name : option.get_snames()) row.names.push_back("-" + name);
    for (const auto& name : option.get_lnames()) row.names.push_back("--" + name);
  }
  if (option.get_items_expected_max() > 0) put_type(option.get_type_name(), row);
  row.default_value = row.choices.empty() ? option.get_default_str() : "";
  row.description = option.get_description();
  row.group = option.get_group();
  row.required = option.get_required();
  return row;
}

void add(const CLI::App& app, const std::vector<std::string>& path, std::vector<CommandRow>& rows) {
  CommandRow row;
  row.path = path;
  row.aliases = app.get_aliases();
  row.description = app.get_description();
  for (const CLI::Option* option : app.get_options()) {
    if (!option->get_group().empty()) row.options.push_back(row_of(*option));
  }
  const auto below =
      app.get_subcommands([](const CLI::App* command) { return !command->get_group().empty(); });
  for (const CLI::App* command : below) {
    row.commands.push_back(command->get_name());
    const auto& aliases = command->get_aliases();
    row.commands.insert(row.commands.end(), aliases.begin(), aliases.end());
  }
  rows.push_back(std::move(row));
  for (const CLI::App* command : below) {
    auto deeper = path;
    deeper.push_back(command->get_name());
    add(*command, deeper, rows);
  }
}

}  // namespace

std::vector<CommandRow> command_table(const CLI::App& app) {
  std::vector<CommandRow> rows;
  add(app, {}, rows);
  return rows;
}

std::string json_of(const std::vector<CommandRow>& table) { return nlohmann::json(table).dump(); }

std::vector<CommandRow> table_of_json(const std::string& text) {
  try {
    return nlohmann::json::parse(text).get<std::vector<CommandRow>>();
  } catch (const nlohmann::json::exception&) {
    return {};
  }
}

}  // namespace flowdlo::support
