// HintOptions: what is known beside a frame, from the command line.
#pragma once

#include <CLI/App.hpp>
#include <filesystem>
#include <string>
#include <vector>

#include "flowdlo/hints.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::tools {

struct HintArguments {
  std::string first_end;          ///< "U,V"; empty: none
  std::vector<std::string> ends;  ///< the same
  bool ring = false;
  std::filesystem::path previous;
};

/// Adds --first-end, --end, --ring and --previous. `arguments` must outlive the command's parsing.
void add_hint_options(CLI::App& command, HintArguments& arguments);

/// Reads --previous, an estimate.json that an earlier run wrote. Fails with kIo or kBadInput,
/// naming option and file.
[[nodiscard]] Result<Hints> hints_of(const HintArguments& arguments);

}  // namespace flowdlo::tools
