// Choice: an option whose value is one of a few names.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <algorithm>
#include <cctype>
#include <string>
#include <utility>
#include <vector>

#include "files/shown_name.hpp"

namespace flowdlo::support {

/// Turns a name, in any case, into the number of its enumerator, which CLI11 then reads; refuses
/// anything else. Help shows the names, "full|fast": the numbers are nobody's business.
template <class Value>
[[nodiscard]] CLI::Validator choice(std::vector<std::pair<std::string, Value>> names) {
  std::vector<std::string> words;
  for (const auto& [name, value] : names) words.push_back(name);
  const std::string all = fmt::format("{}", fmt::join(words, "|"));
  return {[names = std::move(names), all](std::string& text) {
            std::string word = text;
            std::transform(word.begin(), word.end(), word.begin(), [](unsigned char letter) {
              return static_cast<char>(std::tolower(letter));
            });
            for (const auto& [name, value] : names) {
              if (name != word) continue;
              text = std::to_string(static_cast<int>(value));
              return std::string();
            }
            return fmt::format("expected {}, got \"{}\"", all, files::shown(text));
          },
          all};
}

}  // namespace flowdlo::support
