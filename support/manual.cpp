#include "manual.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace flowdlo::support {
namespace {

/// Text that roff prints as it stands.
std::string plain(const std::string& text) {
  std::string out;
  for (const char letter : text) {
    const bool begins = out.empty() || out.back() == '\n';
    if (begins && (letter == '.' || letter == '\'')) out += "\\&";
    if (letter == '\\') {
      out += "\\e";
    } else if (letter == '-') {
      out += "\\-";
    } else {
      out += letter;
    }
  }
  return out;
}

std::string page_name(const std::string& name, const CommandRow& row) {
  std::string out = name;
  for (const auto& word : row.path) out += "-" + word;
  return out;
}

std::string synopsis_of(const std::string& name, const CommandRow& row) {
  std::string words = plain(name);
  for (const auto& word : row.path) words.append(" ").append(plain(word));
  std::string line = fmt::format("\\fB{}\\fR", words);
  if (!row.commands.empty() && row.path.empty()) return line + " \\fICOMMAND\\fR ...";
  line += " [\\fIoptions\\fR]";
  for (const auto& option : row.options) {
    if (!option.positional) continue;
    const auto argument = fmt::format("\\fI{}\\fR", plain(option.names.front()));
    line += option.required ? " " + argument : fmt::format(" [{}]", argument);
  }
  if (!row.commands.empty()) line += " [\\fICOMMAND\\fR ...]";
  return line;
}

std::string entry_of(const OptionRow& option) {
  std::string names;
  for (const auto& name : option.names) {
    if (!names.empty()) names += ", ";
    names += fmt::format("\\f{}{}\\fR", option.positional ? 'I' : 'B', plain(name));
  }
  const bool says_more = !option.value.empty() && !option.positional;
  std::string out = fmt::format(".TP\n{}", names);
  if (says_more) out += fmt::format(" \\fI{}\\fR", plain(option.value));
  out += fmt::format("\n{}", plain(option.description));
  if (!option.limits.empty()) out += fmt::format(" ({})", plain(option.limits));
  if (!option.default_value.empty()) out += fmt::format(" [{}]", plain(option.default_value));
  return out + "\n";
}

std::string options_of(const CommandRow& row) {
  std::vector<std::string> groups;
  std::string arguments;
  for (const auto& option : row.options) {
    if (option.positional) {
      arguments += entry_of(option);
    } else if (std::find(groups.begin(), groups.end(), option.group) == groups.end()) {
      groups.push_back(option.group);
    }
  }
  std::string out;
  if (!arguments.empty()) out += ".SH ARGUMENTS\n" + arguments;
  for (const auto& group : groups) {
    std::string heading = group;
    std::transform(heading.begin(), heading.end(), heading.begin(),
                   [](unsigned char letter) { return static_cast<char>(std::toupper(letter)); });
    out += ".SH " + plain(heading) + "\n";
    for (const auto& option : row.options) {
      if (!option.positional && option.group == group) out += entry_of(option);
    }
  }
  return out;
}

std::string commands_below(const std::string& name, const CommandRow& row,
                           const std::vector<CommandRow>& table) {
  std::string out;
  for (const auto& other : table) {
    const bool below = other.path.size() == row.path.size() + 1 &&
                       std::equal(row.path.begin(), row.path.end(), other.path.begin());
    if (!below) continue;
    out += fmt::format(".TP\n\\fB{}\\fR(1)\n{}\n", plain(page_name(name, other)),
                       plain(other.description));
  }
  return out.empty() ? out : ".SH COMMANDS\n" + out;
}

constexpr const char* kExitStatus = R"(.SH EXIT STATUS
0: everything was done. 1: some frame has no result, or a file or a device failed; what was wrong is
said on standard error. 2: wrong usage: an argument, the weights, or the device asked for.
)";

}  // namespace

std::vector<ManualPage> manual(const std::string& name, const std::string& version,
                               const std::vector<CommandRow>& table) {
  std::vector<ManualPage> pages;
  for (const auto& row : table) {
    const auto page = page_name(name, row);
    std::string upper = page;
    std::transform(upper.begin(), upper.end(), upper.begin(),
                   [](unsigned char letter) { return static_cast<char>(std::toupper(letter)); });
    std::string text = fmt::format(
        ".TH \"{}\" 1 \"\" \"{} {}\" \"FlowDLO\"\n.SH NAME\n{} \\- {}\n.SH SYNOPSIS\n{}\n",
        plain(upper), name, version, plain(page), plain(row.description), synopsis_of(name, row));
    if (!row.aliases.empty()) {
      text += fmt::format(".SH DESCRIPTION\nAlso called \\fB{}\\fR.\n",
                          plain(fmt::format("{}", fmt::join(row.aliases, ", "))));
    }
    text += commands_below(name, row, table) + options_of(row) + kExitStatus;
    if (!row.path.empty()) {
      text += fmt::format(".SH SEE ALSO\n\\fB{}\\fR(1)\n", plain(name));
    }
    pages.push_back({page + ".1", std::move(text)});
  }
  return pages;
}

}  // namespace flowdlo::support
