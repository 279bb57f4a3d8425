// trial.json: a trial as one line of text, to the last bit, so that tables made of what was read
// back are those of what was measured.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "eval/trial.hpp"
#include "flowdlo/result.hpp"

namespace flowdlo::eval {

/// A trial and its place in the data set.
struct Row {
  std::size_t index = 0;
  Trial trial;
};

/// One line of JSON, without its end. Numbers that are not finite come back as NaN.
[[nodiscard]] std::string row_json(const Row& row);

/// Fails with kBadInput, naming `who`.
[[nodiscard]] Result<Row> parse_row(std::string_view line, const std::string& who);

}  // namespace flowdlo::eval
