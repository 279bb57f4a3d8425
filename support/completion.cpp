#include "completion.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace flowdlo::support {
namespace {

/// In single quotes, for any of the three shells.
std::string in_quotes(const std::string& text) {
  std::string out = "'";
  for (const char letter : text) {
    if (letter == '\'') {
      out += "'\\''";
    } else {
      out += letter == '\n' ? ' ' : letter;
    }
  }
  return out + "'";
}

/// " weights info": as the scripts gather it word by word.
std::string path_of(const CommandRow& row) {
  std::string path;
  for (const auto& word : row.path) path.append(" ").append(word);
  return path;
}

std::vector<std::string> option_names(const CommandRow& row) {
  std::vector<std::string> names;
  for (const auto& option : row.options) {
    if (!option.positional) {
      names.insert(names.end(), option.names.begin(), option.names.end());
    }
  }
  return names;
}

/// The cases that follow the words of the line down the commands, in the shell's `variable`.
std::string walk(const std::vector<CommandRow>& table, const char* variable) {
  std::string out;
  for (const auto& row : table) {
    if (row.path.empty()) continue;
    std::string above;
    for (std::size_t i = 0; i + 1 < row.path.size(); ++i) above.append(" ").append(row.path[i]);
    std::vector<std::string> names = {row.path.back()};
    names.insert(names.end(), row.aliases.begin(), row.aliases.end());
    for (const auto& name : names) {
      out += fmt::format("      \"{} {}\") {}=\"{}\" ;;\n", above, name, variable, path_of(row));
    }
  }
  return out;
}

std::string bash(const std::string& name, const std::vector<CommandRow>& table) {
  std::string values;
  std::string words;
  for (const auto& row : table) {
    const auto path = path_of(row);
    for (const auto& option : row.options) {
      if (option.choices.empty()) continue;
      for (const auto& word : option.names) {
        values += fmt::format("    \"{} {}\") words=\"{}\" ;;\n", path, word,
                              fmt::join(option.choices, " "));
      }
    }
    words += fmt::format("    \"{}\") commands=\"{}\" options=\"{}\" ;;\n", path,
                         fmt::join(row.commands, " "), fmt::join(option_names(row), " "));
  }
  return fmt::format(R"(# bash completion for {0}; made by "{0} completion bash".
_{0}() {{
  local cur=${{COMP_WORDS[COMP_CWORD]}} prev=${{COMP_WORDS[COMP_CWORD-1]}}
  local path="" words="" commands="" options="" i
  for ((i = 1; i < COMP_CWORD; i++)); do
    case "$path ${{COMP_WORDS[i]}}" in
{1}    esac
  done
  case "$path $prev" in
{2}  esac
  if [[ -z $words ]]; then
    case "$path" in
{3}    esac
    if [[ $cur == -* ]]; then words=$options; else words=$commands; fi
  fi
  COMPREPLY=()
  for i in $words; do
    if [[ $i == "$cur"* ]]; then COMPREPLY+=("$i"); fi
  done
}}
complete -o default -F _{0} {0}
)",
                     name, walk(table, "path"), values, words);
}

std::string zsh(const std::string& name, const std::vector<CommandRow>& table) {
  std::string cases;
  for (const auto& row : table) {
    cases += fmt::format("    \"{}\")\n      commands=({}) options=(", path_of(row),
                         fmt::join(row.commands, " "));
    for (const auto& option : row.options) {
      if (option.positional) continue;
      for (const auto& word : option.names) {
        cases += fmt::format(" {}", in_quotes(fmt::format("{}[{}]", word, option.description)));
      }
    }
    cases += ") ;;\n";
  }
  std::string values;
  for (const auto& row : table) {
    for (const auto& option : row.options) {
      if (option.choices.empty()) continue;
      for (const auto& word : option.names) {
        values += fmt::format("    \"{} {}\") compadd -- {}; return ;;\n", path_of(row), word,
                              fmt::join(option.choices, " "));
      }
    }
  }
  return fmt::format(R"(#compdef {0}
# zsh completion for {0}; made by "{0} completion zsh".
_{0}() {{
  local path_of_words="" i
  local -a commands options plain
  for ((i = 2; i < CURRENT; i++)); do
    case "$path_of_words $words[i]" in
{1}    esac
  done
  case "$path_of_words $words[CURRENT-1]" in
{2}  esac
  case "$path_of_words" in
{3}  esac
  if [[ $words[CURRENT] == -* ]]; then
    for i in $options; do plain+=("${{i%%\[*}}"); done
    compadd -d options -- $plain
  elif (( $#commands )); then
    compadd -- $commands
  else
    _files
  fi
}}
_{0} "$@"
)",
                     name, walk(table, "path_of_words"), values, cases);
}

std::string fish(const std::string& name, const std::vector<CommandRow>& table) {
  std::string out =
      fmt::format("# fish completion for {0}; made by \"{0} completion fish\".\n", name);
  for (const auto& row : table) {
    std::string when = "__fish_use_subcommand";
    if (!row.path.empty()) {
      when.clear();
      for (const auto& word : row.path) {
        when += fmt::format("{}__fish_seen_subcommand_from {}", when.empty() ? "" : "; and ", word);
        if (row.path.size() == 1) when += fmt::format(" {}", fmt::join(row.aliases, " "));
      }
    }
    const std::string begin = fmt::format("complete -c {} -n {}", name, in_quotes(when));
    for (const auto& command : row.commands) {
      std::string described;
      for (const auto& other : table) {
        auto path = row.path;
        path.push_back(command);
        if (other.path == path) described = other.description;
      }
      out += fmt::format("{} -f -a {} -d {}\n", begin, command, in_quotes(described));
    }
    for (const auto& option : row.options) {
      if (option.positional) continue;
      out += begin;
      for (const auto& word : option.names) {
        const bool is_long = word.starts_with("--");
        out.append(is_long ? " -l " : " -s ").append(word.substr(is_long ? 2 : 1));
      }
      if (!option.choices.empty()) {
        out +=
            fmt::format(" -x -a {}", in_quotes(fmt::format("{}", fmt::join(option.choices, " "))));
      } else if (!option.value.empty()) {
        out += " -r";
      }
      out += fmt::format(" -d {}\n", in_quotes(option.description));
    }
  }
  return out;
}

}  // namespace

std::string completion(Shell shell, const std::string& name, const std::vector<CommandRow>& table) {
  switch (shell) {
    case Shell::kBash:
      return bash(name, table);
    case Shell::kZsh:
      return zsh(name, table);
    case Shell::kFish:
      return fish(name, table);
  }
  return {};
}

}  // namespace flowdlo::support
